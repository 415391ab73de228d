#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/bags/ros_messages.hpp"

namespace slammot::bags {

/// Tree of a bag's frames: fixed connections, and stamped poses of moving ones.
class FrameTree {
 public:
  /// Pose of a frame in its parent.
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
    std::vector<StampedTransform> poses;  ///< Incomplete for fixed frames.
  };

  /// index: that of the message in the bag.
  void add(const TransformMessage& message, std::int64_t log_time_ns, std::int64_t index = 0);

  /// Pose of child in parent through fixed frames only; nullopt if there is no such connection.
  std::optional<Transform> fixed(const std::string& parent, const std::string& child) const;

  /// First moving edge on the way from this frame to the root; null if none.
  const Edge* first_moving_above(const std::string& frame) const;

  /// Ancestor nearest to the root with a fixed connection to this frame.
  std::string fixed_root(const std::string& frame) const;

  const Edge* edge_above(const std::string& frame) const;
  bool is_empty() const { return edges_.empty(); }

 private:
  /// Pose in that ancestor.
  Transform in_fixed_root(const std::string& frame) const;

  std::map<std::string, Edge> edges_;  ///< Indexed by child.
  std::size_t kept_poses_ = 0;
};

Transform operator*(const Transform& a_from_b, const Transform& b_from_c);
Transform inverse(const Transform& a_from_b);

}  // namespace slammot::bags
