#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/ids.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::graphs {

struct PoseGraphConfig {
  double loop_loss_scale = 3.0;   ///< Sigmas beyond which a loop constraint does not count (truncated least squares); 0: all count.
  int max_iterations = 50;        ///< Of one linearized solve.
  double most_work = 60e3;        ///< Constraints times iterations of one call of optimise(); at least four iterations are done.
};

struct OptimisationSummary {
  double initial_cost = 0.0;     ///< Half the sum of squared (loops: robustified) normalised errors.
  double final_cost = 0.0;
  int iterations = 0;
  bool has_converged = false;
};

/// Submaps as nodes, relative poses between them as constraints (Wang 2004, section 6.1; Grisetti et al. 2010).
/// The first node added stays where it is. Single-threaded: the same calls give the same bits.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config);

  /// Adds a node at its first guess. Precondition: the id is new.
  void add_node(flow::SubmapId id, const geometry::Pose2& map_from_node);

  /// Puts a node elsewhere, as where one that was tied to nothing is found. Precondition: it is known.
  void move_node(flow::SubmapId id, const geometry::Pose2& map_from_node);

  /// Adds what was measured between two nodes. Preconditions: both are known, the covariance is positive definite.
  void add_constraint(const flow::Constraint& constraint);

  /// Moves the nodes to the nearest minimum of the cost, and weighs all loop constraints anew, those without weight as well:
  /// truncated least squares by graduated non-convexity (Yang et al., RA-L 2020, Eqs. (12)-(14)). Where all agree it is plain
  /// least squares. A solution that costs more than the one before under the truncated cost is not taken.
  OptimisationSummary optimise();

  /// Sum of the squared errors, those of odometric constraints with their sigmas scaled, those of loops truncated; of the enabled ones.
  double truncated_cost(double odometric_sigma_scale = 1.0) const;

  /// Within [0, 1]: how much a constraint counts since the last optimise(); by its place in constraints(). Odometric ones: 1.
  double weight(std::size_t constraint) const { return weights_[constraint]; }

  /// A constraint that is not enabled has weight 0 until it is.
  void set_enabled(std::size_t constraint, bool is_enabled);

  bool contains(flow::SubmapId id) const { return index_of_.contains(id); }
  const geometry::Pose2& map_from_node(flow::SubmapId id) const;

  /// All nodes, ascending ids.
  std::vector<flow::CorrectedSubmap> nodes() const;
  const std::vector<flow::Constraint>& constraints() const { return constraints_; }

 private:
  struct Solver;
  std::vector<double> squared_errors() const;

  PoseGraphConfig config_;
  std::map<flow::SubmapId, std::size_t> index_of_;
  std::vector<geometry::Pose2> map_from_node_;
  std::vector<flow::Constraint> constraints_;
  std::vector<double> weights_;      // as constraints_
  std::vector<bool> is_enabled_;     // as constraints_
};

/// Squared Mahalanobis distance between what a constraint measured and what poses say; chi-square with 3 degrees of
/// freedom where the constraint's covariance is all there is.
double squared_error(const flow::Constraint& constraint, const geometry::Pose2& map_from_from,
                     const geometry::Pose2& map_from_to);

}  // namespace slammot::graphs
