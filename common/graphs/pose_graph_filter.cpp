#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/graphs/pose_graph.hpp"
#include "common/graphs/relative_pose.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix3;
using geometry::UncertainPose2;

constexpr double kGateSquaredSigmas = 16.3;  // Chi-square, 3 degrees of freedom, 99.9 %.

}  // namespace

bool PoseGraph::can_continue_filter() const {
  if (!filtered_) return false;
  for (std::size_t i = 0; i < filtered_->is_used.size(); ++i) {
    if (filtered_->is_used[i] && !is_enabled_[i]) return false;
  }
  return true;
}

/// Takes a constraint if at least one of its ends is known. A loop that the gate refuses has weight
/// 0. False if it cannot be taken now.
bool PoseGraph::take_constraint(std::size_t constraint) {
  auto& [filter, slots, is_used] = *filtered_;
  const auto& [from, to, kind, from_to, map_id, verdict] = constraints_[constraint];
  std::optional<std::size_t>& slot_of_from = slots[index_of_.at(from)];
  std::optional<std::size_t>& slot_of_to = slots[index_of_.at(to)];
  if (!slot_of_from && !slot_of_to) return false;
  if (!slot_of_to) {
    slot_of_to = filter.predict(*slot_of_from, from_to);
  } else if (!slot_of_from) {
    slot_of_from = filter.predict(*slot_of_to, geometry::inverse(from_to));
  } else {
    const bool is_gated = kind == flow::ConstraintKind::kLoop && config_.loop_loss_scale > 0.0;
    const bool is_refused = is_gated && filter.squared_innovation(*slot_of_from, *slot_of_to,
                                                                  from_to) > kGateSquaredSigmas;
    weights_[constraint] = is_refused ? 0.0 : 1.0;
    if (is_refused) return false;
    filter.update(*slot_of_from, *slot_of_to, from_to);
  }
  is_used[constraint] = true;
  weights_[constraint] = 1.0;
  return true;
}

/// One pass over the constraints that were not taken yet, in their order. False if none could be
/// taken.
bool PoseGraph::take_next_constraints(std::vector<bool>& is_refused) {
  bool has_progressed = false;
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (filtered_->is_used[i] || !is_enabled_[i] || is_refused[i]) continue;
    const bool is_taken = take_constraint(i);
    is_refused[i] = !is_taken && weights_[i] == 0.0;
    has_progressed = has_progressed || is_taken;
  }
  return has_progressed;
}

/// Fixes the first node of the next island at its pose. False if every node is known.
bool PoseGraph::begin_next_island() {
  auto& slots = filtered_->slots;
  const auto unknown = std::ranges::find_if(slots, [](const auto& slot) { return !slot; });
  if (unknown == slots.end()) return false;
  *unknown = filtered_->filter.add_known(
      map_from_node_[static_cast<std::size_t>(unknown - slots.begin())]);
  return true;
}

OptimisationSummary PoseGraph::filter() {
  if (!can_continue_filter()) filtered_.emplace();
  filtered_->slots.resize(map_from_node_.size());
  filtered_->is_used.resize(constraints_.size(), false);
  for (std::size_t i = 0; i < constraints_.size(); ++i) weights_[i] = is_enabled_[i] ? 1.0 : 0.0;
  std::vector<bool> is_refused(constraints_.size(), false);
  OptimisationSummary summary{.initial_cost = 0.5 * truncated_cost(), .has_converged = true};
  do {
    while (take_next_constraints(is_refused)) ++summary.iterations;
  } while (begin_next_island());
  for (std::size_t i = 0; i < map_from_node_.size(); ++i)
    map_from_node_[i] = filtered_->filter.pose(*filtered_->slots[i]);
  summary.final_cost = 0.5 * truncated_cost();
  return summary;
}

/// Inverse of the information of all active constraints, with the first node held; a weak prior
/// holds nodes of other islands.
std::map<flow::SubmapId, Matrix3> PoseGraph::covariances() const {
  std::map<flow::SubmapId, Matrix3> covariances;
  if (filtered_) {
    for (const auto& [id, index] : index_of_) {
      if (const auto slot = filtered_->slots[index])
        covariances[id] = filtered_->filter.covariance(*slot, *slot);
    }
    return covariances;
  }
  constexpr double kWeakInformation = 1e-12;
  constexpr double kHeldInformation = 1e12;
  const Eigen::Index size = 3 * static_cast<Eigen::Index>(map_from_node_.size());
  Eigen::MatrixXd information = kWeakInformation * Eigen::MatrixXd::Identity(size, size);
  information.topLeftCorner<3, 3>() = kHeldInformation * Matrix3::Identity();
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (!is_enabled_[i]) continue;
    const auto from = static_cast<Eigen::Index>(index_of_.at(constraints_[i].from));
    const auto to = static_cast<Eigen::Index>(index_of_.at(constraints_[i].to));
    const RelativePose relative =
        relative_pose(map_from_node(constraints_[i].from), map_from_node(constraints_[i].to));
    const Matrix3 W = weights_[i] * constraints_[i].from_to.covariance.inverse();
    information.block<3, 3>(3 * from, 3 * from) +=
        relative.by_from.transpose() * W * relative.by_from;
    information.block<3, 3>(3 * to, 3 * to) += relative.by_to.transpose() * W * relative.by_to;
    const Matrix3 cross = relative.by_from.transpose() * W * relative.by_to;
    information.block<3, 3>(3 * from, 3 * to) += cross;
    information.block<3, 3>(3 * to, 3 * from) += cross.transpose();
  }
  const Eigen::MatrixXd covariance = information.llt().solve(Eigen::MatrixXd::Identity(size, size));
  for (const auto& [id, index] : index_of_)
    covariances[id] = covariance.block<3, 3>(3 * static_cast<Eigen::Index>(index),
                                             3 * static_cast<Eigen::Index>(index));
  return covariances;
}

}  // namespace slammot::graphs
