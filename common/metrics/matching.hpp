#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace slammot::metrics {

/// Objects and tracks of one scan, each known by its index in the sequence.
struct MotFrame {
  std::int64_t stamp_ns = 0;
  std::vector<std::size_t> objects;
  std::vector<std::size_t> tracks;
  Eigen::MatrixXd similarity;  ///< Row an object, column a track; in [0, 1].
};

struct MotSequence {
  std::size_t object_count = 0;  ///< Indices are below it.
  std::size_t track_count = 0;
  std::vector<MotFrame> frames;

  std::size_t object_rows() const;
  std::size_t track_rows() const;
};

inline constexpr double kRoundOff = std::numeric_limits<double>::epsilon();  ///< Of similarities.

/// Row and column of a pair in one frame.
struct Match {
  std::size_t object = 0;
  std::size_t track = 0;
};

/// Assignment with the largest sum of scores; pairs with a score of zero or less are excluded. Rows
/// are ascending.
std::vector<Match> best_pairs(const Eigen::MatrixXd& score);

}  // namespace slammot::metrics
