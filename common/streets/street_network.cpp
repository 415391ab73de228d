#include "common/streets/street_network.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace slammot::streets {
namespace {

using geometry::Vector2;

constexpr double kSamePoint_m = 0.5;  // points of two streets nearer than this are one
constexpr double kLongLink_m = 150.0;

/// Numbers points so that those at one place have one number.
class PointIndex {
 public:
  std::size_t number_of(const Vector2& point_m) {
    const auto column = static_cast<std::int64_t>(std::floor(point_m.x() / kSamePoint_m));
    const auto row = static_cast<std::int64_t>(std::floor(point_m.y() / kSamePoint_m));
    for (std::int64_t i = column - 1; i <= column + 1; ++i) {
      for (std::int64_t j = row - 1; j <= row + 1; ++j) {
        const auto known = numbers_.find(key(i, j));
        if (known != numbers_.end() && (points_m_[known->second] - point_m).norm() < kSamePoint_m)
          return known->second;
      }
    }
    numbers_[key(column, row)] = points_m_.size();
    points_m_.push_back(point_m);
    return points_m_.size() - 1;
  }
  const std::vector<Vector2>& points_m() const { return points_m_; }

 private:
  static std::int64_t key(std::int64_t column, std::int64_t row) {
    return (column << 32) ^ (row & 0xffffffff);
  }
  std::unordered_map<std::int64_t, std::size_t> numbers_;
  std::vector<Vector2> points_m_;
};

/// Numbers of a street's points, without repetition of one after itself.
std::vector<std::size_t> numbered(const Street& street, PointIndex& index) {
  std::vector<std::size_t> numbers;
  for (const Vector2& point_m : street.line_m) {
    const std::size_t number = index.number_of(point_m);
    if (numbers.empty() || numbers.back() != number) numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

StreetNetwork::StreetNetwork(const StreetGraph& graph) {
  PointIndex index;
  std::vector<std::vector<std::size_t>> lines;
  for (const Street& street : graph.streets) lines.push_back(numbered(street, index));
  const std::vector<Vector2>& points_m = index.points_m();
  std::vector<int> arms(points_m.size(), 0);
  std::vector<bool> is_node(points_m.size(), false);
  for (const auto& line : lines) {
    if (line.size() < 2) continue;
    for (std::size_t i = 0; i < line.size(); ++i)
      arms[line[i]] += (i > 0 ? 1 : 0) + (i + 1 < line.size() ? 1 : 0);
    is_node[line.front()] = is_node[line.back()] = true;
  }
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> node_of(points_m.size(), kNone);
  const auto node_at = [&](std::size_t point) {
    if (node_of[point] == kNone) {
      node_of[point] = nodes_.size();
      nodes_.push_back({points_m[point], arms[point]});
    }
    return node_of[point];
  };
  for (const auto& line : lines) {
    for (std::size_t begin = 0; begin + 1 < line.size();) {
      double length_m = 0.0;
      std::size_t end = begin;
      std::vector<double> at_m{0.0};
      do {
        length_m += (points_m[line[end + 1]] - points_m[line[end]]).norm();
        at_m.push_back(length_m);
        ++end;
      } while (end + 1 < line.size() && !is_node[line[end]] && arms[line[end]] == 2 &&
               length_m < kLongLink_m);
      for (std::size_t i = begin; i < end; ++i) {
        const Segment segment{points_m[line[i]], points_m[line[i + 1]]};
        segments_.push_back({segment, segment.direction_rad(), links_.size(),
                             at_m[i - begin] / length_m, at_m[i + 1 - begin] / length_m});
      }
      links_.push_back({{node_at(line[begin]), node_at(line[end])}});
      begin = end;
    }
  }
}

bool StreetNetwork::are_joined(std::size_t link_a, std::size_t link_b) const {
  const auto& a = links_[link_a].nodes;
  const auto& b = links_[link_b].nodes;
  return link_a == link_b ||
         std::ranges::any_of(a, [&](std::size_t node) { return node == b[0] || node == b[1]; });
}

}  // namespace slammot::streets
