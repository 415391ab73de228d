#include "common/bags/frame_tree.hpp"

#include <cmath>

namespace slammot::bags {
namespace {

constexpr std::size_t kMaxFrames = 4096;
constexpr std::size_t kMaxKeptPoses = std::size_t{1} << 20;
constexpr std::size_t kMaxStillPoses = 4096;
constexpr int kMaxDepth = 64;  // the transforms of a damaged bag may form a cycle

bool differ(const Transform& a, const Transform& b) {
  constexpr double kSame = 1e-6;
  return (a.translation_m - b.translation_m).norm() > kSame ||
         a.rotation.angularDistance(b.rotation) > kSame;
}

}  // namespace

Transform operator*(const Transform& a_from_b, const Transform& b_from_c) {
  return {a_from_b.translation_m + a_from_b.rotation.normalized() * b_from_c.translation_m,
          a_from_b.rotation * b_from_c.rotation};
}

Transform inverse(const Transform& a_from_b) {
  const Eigen::Quaterniond b_from_a = a_from_b.rotation.conjugate();
  return {-(b_from_a.normalized() * a_from_b.translation_m), b_from_a};
}

void FrameTree::add(const TransformMessage& message, std::int64_t log_time_ns, std::int64_t index) {
  if (message.child_frame.empty() || message.child_frame == message.header.frame) return;
  if (edges_.size() >= kMaxFrames && !edges_.contains(message.child_frame)) return;
  Edge& edge = edges_[message.child_frame];
  if (edge.messages > 0 && edge.parent != message.header.frame)
    return;  // of two contradicting publishers the first one is used
  edge.parent = message.header.frame;
  edge.child = message.child_frame;
  ++edge.messages;
  const StampedTransform pose{log_time_ns, message.header.stamp_ns, index,
                              message.parent_from_child};
  edge.moves = edge.moves || (!edge.poses.empty() && differ(edge.poses.front().parent_from_child,
                                                            message.parent_from_child));
  // A fixed transform is republished often: only the newest one is kept.
  if (!edge.moves && edge.poses.size() >= kMaxStillPoses) edge.poses.back() = pose;
  else if (edge.poses.empty() || ++kept_poses_ <= kMaxKeptPoses) edge.poses.push_back(pose);
}

const FrameTree::Edge* FrameTree::edge_above(const std::string& frame) const {
  const auto edge = edges_.find(frame);
  return edge == edges_.end() ? nullptr : &edge->second;
}

const FrameTree::Edge* FrameTree::first_moving_above(const std::string& frame) const {
  return edge_above(fixed_root(frame));
}

std::string FrameTree::fixed_root(const std::string& frame) const {
  std::string root = frame;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    const Edge* const edge = edge_above(root);
    if (edge == nullptr || edge->moves) return root;
    root = edge->parent;
  }
  return frame;
}

Transform FrameTree::in_fixed_root(const std::string& frame) const {
  Transform root_from_frame;
  std::string at = frame;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    const Edge* const edge = edge_above(at);
    if (edge == nullptr || edge->moves) break;
    root_from_frame = edge->poses.front().parent_from_child * root_from_frame;
    at = edge->parent;
  }
  return root_from_frame;
}

std::optional<Transform> FrameTree::fixed(const std::string& parent,
                                          const std::string& child) const {
  if (parent == child) return Transform{};
  if (fixed_root(parent) != fixed_root(child)) return std::nullopt;
  if (edge_above(parent) == nullptr || edge_above(parent)->moves)
    return in_fixed_root(child);  // the usual case, without rounding
  return inverse(in_fixed_root(parent)) * in_fixed_root(child);
}

}  // namespace slammot::bags
