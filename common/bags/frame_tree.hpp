#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/bags/ros_messages.hpp"

namespace slammot::bags {

/// How the frames of a bag hang together: which are fixed to each other, and where each moving one was when.
class FrameTree {
 public:
  /// A pose of a frame in its parent.
  struct StampedTransform {
    std::int64_t log_time_ns = 0;
    std::int64_t stamp_ns = 0;
    std::int64_t index = 0;
    Transform parent_from_child;
  };

  struct Edge {
    std::string parent;
    std::string child;
    std::uint64_t messages = 0;
    bool moves = false;
    std::vector<StampedTransform> poses;   ///< Not all of those that do not move.
  };

  /// index: of the message in the bag.
  void add(const TransformMessage& message, std::int64_t log_time_ns, std::int64_t index = 0);

  /// The child in the parent, be it fixed to it through any number of frames; nullopt where it is not.
  std::optional<Transform> fixed(const std::string& parent, const std::string& child) const;

  /// The first edge that moves on the way from this frame to the root; null where nothing moves.
  const Edge* first_moving_above(const std::string& frame) const;

  /// The farthest frame towards the root that this one is fixed to.
  std::string fixed_root(const std::string& frame) const;

  const Edge* edge_above(const std::string& frame) const;
  bool is_empty() const { return edges_.empty(); }

 private:
  /// In its farthest frame that it is fixed to.
  Transform in_fixed_root(const std::string& frame) const;

  std::map<std::string, Edge> edges_;      ///< By child.
  std::size_t kept_poses_ = 0;
};

Transform operator*(const Transform& a_from_b, const Transform& b_from_c);
Transform inverse(const Transform& a_from_b);

}  // namespace slammot::bags
