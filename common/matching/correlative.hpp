#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"
#include "common/matching/smear_kernel.hpp"

namespace slammot::matching {

/// A target point that scans are matched against.
struct TargetPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float weight = 1.0F;  ///< In (0, 1]: score of a source point exactly here.
};

/// Part of the target frame that is rasterized.
struct TargetRegion {
  geometry::Vector2 centre_m = geometry::Vector2::Zero();
  double half_width_m = 20.0;    ///< Along x.
  double half_height_m = 20.0;   ///< Along y.
  double largest_shift_m = 0.5;  ///< Largest half width of later search windows.
};

/// Half widths of the search window around the initial pose, in the target frame.
struct SearchWindow {
  double half_x_m = 0.5;
  double half_y_m = 0.5;
  double half_heading_rad = 0.35;
};

struct CorrelativeConfig {
  double resolution_m = 0.1;      ///< Cell of the finest grid, and search step.
  double smear_sigma_m = 0.1;     ///< Sigma of the Gaussian around every target point.
  double heading_step_rad = 0.0;  ///< 0: the step that moves the farthest points by one cell.
  double min_score = 0.3;         ///< Peaks with lower scores are not searched.
  std::size_t max_peaks = 1;
  double min_peak_ratio = 0.7;       ///< Further peaks score at least this share of the best.
  double peak_separation_m = 0.5;    ///< Further peaks differ by more than this in x or y
  double peak_separation_rad = 0.1;  ///< or by more than this in heading.
};

struct Peak {
  geometry::Pose2 target_from_source;
  double score = 0.0;  ///< In [0, 1]: mean likelihood of the points.
};

/// Exhaustive correlative search for the pose, exact on its grid, by branch and bound over a
/// pyramid of sliding maxima (Olson, ICRA 2009; Hess et al., ICRA 2016, Algorithms 2 and 3). Sums
/// are integers, so that the result does not depend on the order of evaluation. Reuses its buffers;
/// use one instance a thread.
class CorrelativeMatcher {
 public:
  explicit CorrelativeMatcher(const CorrelativeConfig& config);

  /// Sets the target and replaces the previous one. Points outside the region contribute only their
  /// smear.
  void set_target(std::span<const TargetPoint> points, const TargetRegion& region);

  /// Returns the best peaks in the window around the initial pose, best first; at most max_peaks,
  /// none below min_score. The first is the maximum over the window; the others are local maxima.
  /// Windows wider than the region's largest_shift_m are cut to it. Empty if there are no points.
  std::vector<Peak> search(std::span<const Eigen::Vector2f> points_in_source_m,
                           const geometry::Pose2& target_from_source, const SearchWindow& window);

  /// Score of one pose, in [0, 1].
  double score(std::span<const Eigen::Vector2f> points_in_source_m,
               const geometry::Pose2& target_from_source) const;

 private:
  struct Cell {
    std::int32_t column;
    std::int32_t row;
  };
  /// Points rotated by one heading, as offsets into a level of the pyramid.
  struct TurnedPoints {
    double heading_offset_rad = 0.0;
    std::uint32_t first = 0;  ///< Index into offsets_.
    std::uint32_t count = 0;  ///< Points that reach the grid from anywhere in the window.
  };
  /// Block of shifts [column, column + 2^level) x [row, row + 2^level) at one heading, in cells
  /// from the initial pose.
  struct Block {
    std::uint32_t bound = 0;
    std::uint32_t heading = 0;
    std::int32_t column = 0;
    std::int32_t row = 0;
  };
  struct Shifts {
    std::int32_t columns = 0;  ///< Half width of the window in cells.
    std::int32_t rows = 0;
    std::int32_t headings = 0;
  };

  void lay_out(const TargetRegion& region);
  const std::uint8_t* kernel_for(const geometry::Vector2& point_in_target_m,
                                 const Cell& cell) const;
  void stamp(std::span<const TargetPoint> points);
  void build_pyramid();
  Cell cell_of(const geometry::Vector2& point_in_target_m) const;
  double heading_step_for(std::span<const Eigen::Vector2f> points) const;
  void turn_points(std::span<const Eigen::Vector2f> points, const geometry::Pose2& initial,
                   const Shifts& shifts);
  void collect_top_blocks(const Shifts& shifts);
  std::uint32_t bound_of(std::uint32_t heading, std::int32_t column, std::int32_t row,
                         int level) const;
  void descend(const Block& block, int level, const Shifts& shifts, Block& best) const;
  bool may_hold_a_new_peak(const Block& block, int level) const;
  bool is_local_maximum(const Block& leaf, const Shifts& shifts) const;
  geometry::Pose2 pose_of(const Block& leaf) const;

  CorrelativeConfig config_;
  SmearKernel kernel_;
  std::int32_t kernel_half_ = 0;

  double min_x_m_ = 0.0;  ///< Coordinate of cell (0, 0) of the padded grid.
  double min_y_m_ = 0.0;
  std::int32_t columns_ = 0;  ///< Padded by pad_ on each side, so that no shift in the window
                              ///< leaves the grid.
  std::int32_t rows_ = 0;
  std::int32_t pad_ = 0;
  std::int32_t largest_shift_ = 0;
  int top_level_ = 0;
  std::vector<std::vector<std::uint8_t>> pyramid_;  ///< Level k: maximum over the 2^k x 2^k cells
                                                    ///< that begin at this one.

  geometry::Pose2 initial_;
  double heading_step_rad_ = 0.0;
  std::vector<TurnedPoints> headings_;
  std::vector<std::int32_t> offsets_;
  std::vector<Block> top_blocks_;
  std::vector<Block> found_;
};

}  // namespace slammot::matching
