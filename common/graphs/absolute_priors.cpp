#include "common/graphs/absolute_priors.hpp"

#include <array>
#include <cmath>
#include <map>

#include <ceres/ceres.h>

#include "common/graphs/relative_pose_cost.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix2;
using geometry::Pose2;
using Block = std::array<double, 3>;  // x [m], y [m], heading [rad]

const double kFullWeight = 1.0;

/// Whitened error of a position; blocks: node in map, enu_from_map.
struct PositionError {
  PositionPrior prior;
  Matrix2 whitening;

  template <typename T>
  bool operator()(const T* node, const T* enu, T* residuals) const {
    const auto move = [](const T* pose, const T& x, const T& y) {
      const T cosine = cos(pose[2]);
      const T sine = sin(pose[2]);
      return std::array<T, 2>{pose[0] + cosine * x - sine * y, pose[1] + sine * x + cosine * y};
    };
    const auto in_map = move(node, T(prior.in_node_m.x()), T(prior.in_node_m.y()));
    const auto in_enu = move(enu, in_map[0], in_map[1]);
    const T east = in_enu[0] - prior.in_enu_m.x();
    const T north = in_enu[1] - prior.in_enu_m.y();
    residuals[0] = whitening(0, 0) * east + whitening(0, 1) * north;
    residuals[1] = whitening(1, 1) * north;
    return true;
  }
};

/// Whitened error of a heading; blocks: node in map, enu_from_map, bias.
struct HeadingError {
  double read_rad;   ///< Reading without the heading in the node.
  double about_rad;  ///< An expected error, about which it is wrapped.
  double sigma_rad;

  template <typename T>
  bool operator()(const T* node, const T* enu, const T* bias, T* residual) const {
    residual[0] = (enu[2] + node[2] + bias[0] - read_rad - about_rad) / sigma_rad;
    return true;
  }
};

/// One problem over the graph and the inliers.
class Bender {
 public:
  Bender(const std::vector<flow::CorrectedSubmap>& nodes, const AbsoluteFit& fit)
      : fit_(fit),
        enu_{fit.enu_from_map.x_m, fit.enu_from_map.y_m, fit.enu_from_map.heading_rad},
        bias_(fit.heading_bias_rad) {
    for (const flow::CorrectedSubmap& node : nodes)
      blocks_[node.submap_id] = {node.map_from_submap.x_m, node.map_from_submap.y_m,
                                 node.map_from_submap.heading_rad};
  }

  void add(std::span<const flow::Constraint> constraints) {
    for (const flow::Constraint& constraint : constraints) {
      problem_.AddResidualBlock(
          new RelativePoseCost(constraint.from_to.pose, whitening_of(constraint.from_to.covariance),
                               kFullWeight),
          nullptr, blocks_.at(constraint.from).data(), blocks_.at(constraint.to).data());
    }
  }

  void add(const std::vector<PositionPrior>& priors) {
    const PriorAgreement& agreement = fit_.positions;
    const double factor = agreement.scale * agreement.scale * agreement.correlated;
    for (std::size_t i = 0; i < priors.size(); ++i) {
      if (!agreement.is_inlier[i]) continue;
      const Matrix2 whitening =
          Matrix2((factor * priors[i].covariance_m2).inverse()).llt().matrixU();
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PositionError, 2, 3, 3>(
                                    new PositionError{priors[i], whitening}),
                                nullptr, blocks_.at(priors[i].node).data(), enu_.data());
    }
  }

  void add(const std::vector<HeadingPrior>& priors) {
    const PriorAgreement& agreement = fit_.headings;
    const double factor = agreement.scale * std::sqrt(agreement.correlated);
    for (std::size_t i = 0; i < priors.size(); ++i) {
      if (!agreement.is_inlier[i]) continue;
      Block& node = blocks_.at(priors[i].node);
      const double read_rad = priors[i].in_enu_rad - priors[i].in_node_rad;
      const double error_rad = enu_[2] + node[2] + bias_ - read_rad;
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<HeadingError, 1, 3, 3, 1>(new HeadingError{
              read_rad, error_rad - geometry::wrap_angle(error_rad), factor * priors[i].sigma_rad}),
          nullptr, node.data(), enu_.data(), &bias_);
    }
  }

  std::optional<BentGraph> solve() {
    fix_what_is_known();
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 20;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    BentGraph bent{{}, fit_, 2.0 * (summary.initial_cost - summary.final_cost)};
    for (const auto& [id, block] : blocks_)
      bent.nodes.push_back({id, {block[0], block[1], geometry::wrap_angle(block[2])}});
    bent.fit.enu_from_map = {enu_[0], enu_[1], geometry::wrap_angle(enu_[2])};
    bent.fit.heading_bias_rad = bias_;
    return bent;
  }

 private:
  /// The first node defines the map. Without positions neither they nor the bias are observable.
  void fix_what_is_known() {
    const auto fix = [&](double* block) {
      if (problem_.HasParameterBlock(block)) problem_.SetParameterBlockConstant(block);
    };
    fix(blocks_.begin()->second.data());
    if (fit_.has_position) return;
    fix(&bias_);
    if (problem_.HasParameterBlock(enu_.data()))
      problem_.SetManifold(enu_.data(), new ceres::SubsetManifold(3, {0, 1}));
  }

  const AbsoluteFit& fit_;
  std::map<flow::SubmapId, Block> blocks_;
  Block enu_;
  double bias_;
  ceres::Problem problem_;
};

}  // namespace

std::optional<BentGraph> bend(const std::vector<flow::CorrectedSubmap>& nodes,
                              std::span<const flow::Constraint> constraints,
                              const AbsolutePriors& priors, const AbsoluteFit& fit) {
  Bender bender(nodes, fit);
  bender.add(constraints);
  if (fit.has_position) bender.add(priors.positions);
  bender.add(priors.headings);
  return bender.solve();
}

}  // namespace slammot::graphs
