#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/ids.hpp"
#include "common/geometry/pose2.hpp"
#include "common/graphs/submap_filter.hpp"

namespace slammot::graphs {

/// What estimates the poses from the constraints.
enum class Estimator {
  kGraph,  ///< Least squares over all constraints (Grisetti et al. 2010).
  kEkf,    ///< Extended Kalman filter over submaps as features (Wang 2004, sections 2.2, 3.5).
};

struct PoseGraphConfig {
  Estimator estimator = Estimator::kGraph;
  double loop_loss_scale = 3.0;  ///< Sigmas beyond which a loop constraint is ignored (truncated
                                 ///< least squares); 0: none is ignored.
  int max_iterations = 50;       ///< Of one linearized solve.
  double most_work = 60e3;       ///< Constraints times iterations of one optimise(); at least four
                                 ///< iterations are done.
};

struct OptimisationSummary {
  double initial_cost = 0.0;  ///< Half the sum of squared normalized errors; those of loops are
                              ///< robustified.
  double final_cost = 0.0;
  int iterations = 0;
  bool has_converged = false;
};

/// Pose graph: submaps as nodes, relative poses as constraints (Wang 2004, section 6.1; Grisetti et
/// al. 2010). The first node is fixed. Single-threaded: the same calls give bitwise the same
/// result.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config);

  /// Adds a node at an initial pose. Precondition: the id is new.
  void add_node(flow::SubmapId id, const geometry::Pose2& map_from_node);

  /// Moves a node, for example when an untied one is located. Precondition: the node exists.
  void move_node(flow::SubmapId id, const geometry::Pose2& map_from_node);

  /// Adds a measured relative pose. Preconditions: both nodes exist, the covariance is positive
  /// definite.
  void add_constraint(const flow::Constraint& constraint);

  /// Optimizes the poses to the nearest minimum and recomputes the weights of all loop constraints,
  /// including those with weight 0: truncated least squares by graduated non-convexity (Yang et
  /// al., RA-L 2020, Eqs. (12)-(14)). Without outliers it equals least squares. A solution with a
  /// higher truncated cost than the previous one is rejected.
  ///
  /// The Kalman filter takes the constraints since the last call in their order and ignores a loop
  /// whose innovation exceeds its covariance (gate); where a constraint that it took has been
  /// disabled since, or a node was moved, it begins again.
  OptimisationSummary optimise();

  /// Covariance of each node of the first node's island relative to the first node, after the last
  /// optimise(). Least squares: the inverse of the information, dense; for evaluation.
  std::map<flow::SubmapId, geometry::Matrix3> covariances() const;

  /// Sum of squared errors of the enabled constraints: odometric ones with scaled sigmas, loops
  /// truncated.
  double truncated_cost(double odometric_sigma_scale = 1.0) const;

  /// Weight in [0, 1] of a constraint after the last optimise(), by index in constraints().
  /// Odometric ones: 1.
  double weight(std::size_t constraint) const { return weights_[constraint]; }

  /// True if optimise() would not ignore a loop with the error that it has at the present poses.
  bool fits(const flow::Constraint& loop) const;

  /// A disabled constraint has weight 0.
  void set_enabled(std::size_t constraint, bool is_enabled);

  bool contains(flow::SubmapId id) const { return index_of_.contains(id); }
  const geometry::Pose2& map_from_node(flow::SubmapId id) const;

  /// All nodes, by ascending id.
  std::vector<flow::CorrectedSubmap> nodes() const;
  const std::vector<flow::Constraint>& constraints() const { return constraints_; }

 private:
  struct Solver;
  /// State of the Kalman filter.
  struct Filtered {
    SubmapFilter filter;
    std::vector<std::optional<std::size_t>> slots;  ///< In the filter, of each node.
    std::vector<bool> is_used;                      ///< Of each constraint.
  };

  OptimisationSummary solve();
  OptimisationSummary filter();
  bool can_continue_filter() const;
  bool take_next_constraints(std::vector<bool>& is_refused);
  bool take_constraint(std::size_t constraint);
  bool begin_next_island();
  std::vector<double> squared_errors() const;

  PoseGraphConfig config_;
  std::map<flow::SubmapId, std::size_t> index_of_;
  std::vector<geometry::Pose2> map_from_node_;
  std::vector<flow::Constraint> constraints_;
  std::vector<double> weights_;   // as constraints_
  std::vector<bool> is_enabled_;  // as constraints_
  std::optional<Filtered> filtered_;
};

/// Squared Mahalanobis distance between a constraint's measurement and the poses. Chi-square with 3
/// degrees of freedom if the poses have no error of their own.
double squared_error(const flow::Constraint& constraint, const geometry::Pose2& map_from_from,
                     const geometry::Pose2& map_from_to);

}  // namespace slammot::graphs
