#include "common/graphs/pose_graph.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>

#include <ceres/ceres.h>
#include <Eigen/Cholesky>

#include "common/graphs/relative_pose_cost.hpp"

namespace slammot::graphs {
namespace {

using geometry::Pose2;
using geometry::Vector2;

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-9;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

PoseGraph::PoseGraph(const PoseGraphConfig& config) : config_(config) {}

void PoseGraph::add_node(flow::SubmapId id, const Pose2& map_from_node) {
  assert(!contains(id));
  index_of_.emplace(id, map_from_node_.size());
  map_from_node_.push_back(map_from_node);
}

void PoseGraph::move_node(flow::SubmapId id, const Pose2& map_from_node) {
  map_from_node_[index_of_.at(id)] = map_from_node;
  filtered_.reset();
}

void PoseGraph::add_constraint(const flow::Constraint& constraint) {
  assert(contains(constraint.from) && contains(constraint.to));
  constraints_.push_back(constraint);
  weights_.push_back(1.0);
  is_enabled_.push_back(true);
}

void PoseGraph::set_enabled(std::size_t constraint, bool is_enabled) {
  is_enabled_[constraint] = is_enabled;
  weights_[constraint] = is_enabled ? 1.0 : 0.0;
}

bool PoseGraph::fits(const flow::Constraint& loop) const {
  const double limit = config_.loop_loss_scale * config_.loop_loss_scale;
  return limit <= 0.0 ||
         squared_error(loop, map_from_node(loop.from), map_from_node(loop.to)) <= limit;
}

/// One problem that is solved repeatedly with changing weights; it optimizes the graph's poses in
/// place.
struct PoseGraph::Solver {
  explicit Solver(PoseGraph& graph) : graph_(graph) {
    for (const Pose2& pose : graph.map_from_node_)
      blocks_.push_back({pose.x_m, pose.y_m, pose.heading_rad});
    for (std::size_t i = 0; i < graph.constraints_.size(); ++i) {
      if (!graph.is_enabled_[i]) continue;
      const flow::Constraint& constraint = graph.constraints_[i];
      // The problem takes ownership of its cost functions.
      problem_.AddResidualBlock(
          new RelativePoseCost(constraint.from_to.pose, whitening_of(constraint.from_to.covariance),
                               graph.weights_[i]),
          nullptr, blocks_[graph.index_of_.at(constraint.from)].data(),
          blocks_[graph.index_of_.at(constraint.to)].data());
    }
    if (problem_.HasParameterBlock(blocks_.front().data()))
      problem_.SetParameterBlockConstant(blocks_.front().data());
    iterations_left_ = std::max(
        4,
        static_cast<int>(graph.config_.most_work / static_cast<double>(graph.constraints_.size())));
  }

  bool has_iterations_left() const { return iterations_left_ > 0; }

  /// True if the poses are a solution.
  bool solve(int max_iterations) {
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(std::min(max_iterations, iterations_left_)), &problem_, &summary);
    const int iterations = std::max(static_cast<int>(summary.iterations.size()) - 1, 1);
    iterations_left_ -= iterations;
    if (!has_solved_) result_.initial_cost = summary.initial_cost;
    has_solved_ = true;
    result_.final_cost = summary.final_cost;
    result_.iterations += iterations;
    result_.has_converged = summary.termination_type == ceres::CONVERGENCE;
    if (!summary.IsSolutionUsable()) return false;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      graph_.map_from_node_[i] = {blocks_[i][0], blocks_[i][1],
                                  geometry::wrap_angle(blocks_[i][2])};
    }
    return true;
  }

  const OptimisationSummary& result() const { return result_; }

 private:
  PoseGraph& graph_;
  std::vector<std::array<double, 3>> blocks_;
  ceres::Problem problem_;
  OptimisationSummary result_;
  int iterations_left_ = 0;
  bool has_solved_ = false;
};

std::vector<double> PoseGraph::squared_errors() const {
  std::vector<double> errors;
  for (const flow::Constraint& constraint : constraints_)
    errors.push_back(
        squared_error(constraint, map_from_node(constraint.from), map_from_node(constraint.to)));
  return errors;
}

double PoseGraph::truncated_cost(double odometric_sigma_scale) const {
  const double limit = config_.loop_loss_scale * config_.loop_loss_scale;
  const std::vector<double> errors = squared_errors();
  double cost = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!is_enabled_[i]) continue;
    const bool is_loop = constraints_[i].kind == flow::ConstraintKind::kLoop;
    if (!is_loop) cost += errors[i] / (odometric_sigma_scale * odometric_sigma_scale);
    else cost += limit > 0.0 ? std::min(errors[i], limit) : errors[i];
  }
  return cost;
}

OptimisationSummary PoseGraph::optimise() {
  if (constraints_.empty()) return {.has_converged = true};
  return config_.estimator == Estimator::kEkf ? filter() : solve();
}

OptimisationSummary PoseGraph::solve() {
  constexpr double kGrowth = 1.6;  // growth of the non-convexity per step
  constexpr int kIterationsPerStep = 3;
  constexpr int kMostSteps = 40;
  const double limit = config_.loop_loss_scale * config_.loop_loss_scale;
  const auto can_lose_weight = [&](std::size_t i) {
    return is_enabled_[i] && constraints_[i].kind == flow::ConstraintKind::kLoop && limit > 0.0;
  };
  const double cost_before = truncated_cost();
  const std::vector<Pose2> poses_before = map_from_node_;
  const std::vector<double> weights_before = weights_;
  Solver solver(*this);
  const auto go_back = [&] {
    map_from_node_ = poses_before;
    weights_ = weights_before;
    return solver.result();
  };
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] = is_enabled_[i] ? 1.0 : 0.0;
  if (!solver.solve(config_.max_iterations)) return go_back();
  const auto largest_error = [&](const std::vector<double>& errors) {
    double largest = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i)
      largest = can_lose_weight(i) ? std::max(largest, errors[i]) : largest;
    return largest;
  };
  std::vector<double> errors = squared_errors();
  if (largest_error(errors) <= limit || limit <= 0.0) return solver.result();
  double mu = limit / (2.0 * largest_error(errors) - limit);
  for (int step = 0; step < kMostSteps && solver.has_iterations_left(); ++step) {
    bool is_decided = true;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (!can_lose_weight(i)) continue;
      const bool is_inlier = errors[i] <= mu / (mu + 1.0) * limit;
      const bool is_outlier = errors[i] >= (mu + 1.0) / mu * limit;
      weights_[i] = is_inlier    ? 1.0
                    : is_outlier ? 0.0
                                 : std::sqrt(limit * mu * (mu + 1.0) / errors[i]) - mu;
      is_decided = is_decided && (is_inlier || is_outlier);
    }
    if (!solver.solve(kIterationsPerStep)) return go_back();
    if (is_decided) break;
    errors = squared_errors();
    mu *= kGrowth;
  }
  if (truncated_cost() > cost_before + 1e-9) map_from_node_ = poses_before;
  errors = squared_errors();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (can_lose_weight(i)) weights_[i] = errors[i] <= limit ? 1.0 : 0.0;
  }
  return solver.result();
}

const Pose2& PoseGraph::map_from_node(flow::SubmapId id) const {
  return map_from_node_[index_of_.at(id)];
}

std::vector<flow::CorrectedSubmap> PoseGraph::nodes() const {
  std::vector<flow::CorrectedSubmap> nodes;
  for (const auto& [id, index] : index_of_) nodes.push_back({id, map_from_node_[index]});
  return nodes;
}

double squared_error(const flow::Constraint& constraint, const Pose2& map_from_from,
                     const Pose2& map_from_to) {
  const Eigen::Vector3d error =
      geometry::difference(geometry::inverse(map_from_from) * map_from_to, constraint.from_to.pose);
  return error.dot(constraint.from_to.covariance.ldlt().solve(error));
}

}  // namespace slammot::graphs
