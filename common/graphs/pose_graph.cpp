#include "common/graphs/pose_graph.hpp"

#include <cassert>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <ceres/ceres.h>

namespace slammot::graphs {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::Vector2;

/// Upper triangular root W of the information: W' W = covariance^-1.
Matrix3 whitening_of(const Matrix3& covariance) {
  return Matrix3(covariance.inverse()).llt().matrixU();
}

/// Error of a relative pose in the frame of `from`, whitened; blocks are (x [m], y [m], heading [rad]) in map.
class RelativePoseCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  RelativePoseCost(const Pose2& measured_from_to, const Matrix3& whitening)
      : measured_(measured_from_to), whitening_(whitening) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Pose2 map_from_from{blocks[0][0], blocks[0][1], blocks[0][2]};
    const Pose2 map_from_to{blocks[1][0], blocks[1][1], blocks[1][2]};
    const Pose2 from_to = geometry::inverse(map_from_from) * map_from_to;
    Eigen::Map<Eigen::Vector3d>{residuals} = whitening_ * geometry::difference(from_to, measured_);
    if (jacobians == nullptr) return true;
    const Eigen::Matrix2d turn_back = geometry::rotation(-map_from_from.heading_rad);
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) {
      Matrix3 J = Matrix3::Zero();
      J.topLeftCorner<2, 2>() = -turn_back;
      J(0, 2) = from_to.y_m;
      J(1, 2) = -from_to.x_m;
      J(2, 2) = -1.0;
      Eigen::Map<RowMajor>{jacobians[0]} = whitening_ * J;
    }
    if (jacobians[1] != nullptr) {
      Matrix3 J = Matrix3::Identity();
      J.topLeftCorner<2, 2>() = turn_back;
      Eigen::Map<RowMajor>{jacobians[1]} = whitening_ * J;
    }
    return true;
  }

 private:
  Pose2 measured_;
  Matrix3 whitening_;
};

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

void PoseGraph::move_node(flow::SubmapId id, const Pose2& map_from_node) { map_from_node_[index_of_.at(id)] = map_from_node; }

void PoseGraph::add_constraint(const flow::Constraint& constraint) {
  assert(contains(constraint.from) && contains(constraint.to));
  constraints_.push_back(constraint);
}

OptimisationSummary PoseGraph::optimise() {
  if (constraints_.empty()) return {.has_converged = true};
  std::vector<std::array<double, 3>> blocks;
  for (const Pose2& pose : map_from_node_) blocks.push_back({pose.x_m, pose.y_m, pose.heading_rad});

  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  std::unique_ptr<ceres::LossFunction> loop_loss;
  if (config_.loop_loss_scale > 0.0) loop_loss = std::make_unique<ceres::CauchyLoss>(config_.loop_loss_scale);
  ceres::Problem problem(problem_options);
  for (const flow::Constraint& constraint : constraints_) {
    ceres::LossFunction* loss = constraint.kind == flow::ConstraintKind::kLoop ? loop_loss.get() : nullptr;
    // The problem takes ownership of its cost functions.
    problem.AddResidualBlock(
        new RelativePoseCost(constraint.from_to.pose, whitening_of(constraint.from_to.covariance)), loss,
        blocks[index_of_.at(constraint.from)].data(), blocks[index_of_.at(constraint.to)].data());
  }
  if (problem.HasParameterBlock(blocks.front().data())) problem.SetParameterBlockConstant(blocks.front().data());

  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(config_.max_iterations), &problem, &summary);
  if (!summary.IsSolutionUsable()) return {.initial_cost = summary.initial_cost, .final_cost = summary.initial_cost};
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    map_from_node_[i] = {blocks[i][0], blocks[i][1], geometry::wrap_angle(blocks[i][2])};
  }
  return {.initial_cost = summary.initial_cost,
          .final_cost = summary.final_cost,
          .iterations = static_cast<int>(summary.iterations.size()) - 1,
          .has_converged = summary.termination_type == ceres::CONVERGENCE};
}

const Pose2& PoseGraph::map_from_node(flow::SubmapId id) const { return map_from_node_[index_of_.at(id)]; }

std::vector<flow::CorrectedSubmap> PoseGraph::nodes() const {
  std::vector<flow::CorrectedSubmap> nodes;
  for (const auto& [id, index] : index_of_) nodes.push_back({id, map_from_node_[index]});
  return nodes;
}

double squared_error(const flow::Constraint& constraint, const Pose2& map_from_from, const Pose2& map_from_to) {
  const Eigen::Vector3d error = geometry::difference(geometry::inverse(map_from_from) * map_from_to, constraint.from_to.pose);
  return error.dot(constraint.from_to.covariance.ldlt().solve(error));
}

}  // namespace slammot::graphs
