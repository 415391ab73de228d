#include "common/matching/wide_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "common/matching/search_grid.hpp"
#include "common/matching/smear_kernel.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr std::uint64_t kTurnWork = 1;        // of rotating one point, in cells read
constexpr std::int32_t kMostCells = 1 << 20;  // on either side of a grid's origin

/// Floor without a function call, by truncation of a non-negative number: search_a_wide_window of
/// the benchmark.
std::int32_t floored(double cells) {
  return static_cast<std::int32_t>(cells + kMostCells) - kMostCells;
}

}  // namespace

WideSearch::WideSearch(std::vector<Eigen::Vector2f> points_in_source_m, double cell_m,
                       const WideSearchConfig& config)
    : points_m_(std::move(points_in_source_m)), cell_m_(cell_m), config_(config) {
  float reach_m = 0.0F;
  for (const Eigen::Vector2f& point : points_m_) reach_m = std::max(reach_m, point.norm());
  reach_m_ = std::max(static_cast<double>(reach_m), cell_m);
  heading_step_rad_ = cell_m / reach_m_;
  least_score_ = config.min_score * SmearKernel::kFull * static_cast<double>(points_m_.size());
  is_done_ = points_m_.empty();
}

int WideSearch::useful_level(const SearchWindow& window, double cell_m) {
  return matching::useful_level(steps_within(std::max(window.half_x_m, window.half_y_m), cell_m));
}

std::uint64_t WideSearch::add_target(WideSearchTarget target) {
  const std::uint64_t work_before = work_;
  Grid grid{.half_columns = steps_within(target.window.half_x_m, cell_m_),
            .half_rows = steps_within(target.window.half_y_m, cell_m_),
            .half_headings = steps_within(
                std::min(target.window.half_heading_rad, std::numbers::pi), heading_step_rad_)};
  int level = std::min(useful_level(target.window, cell_m_), target.pyramid->top_level());
  // Limits the level: a block must not cover more headings than the window.
  while (level > 0 && ScorePyramid::headings_of(level) > 2 * grid.half_headings + 1) --level;
  grid.target = std::move(target);
  grid.looked_at.push_back(0);
  for (std::int32_t step = -grid.half_headings; step <= grid.half_headings; ++step) {
    const bool is_looked_at =
        !grid.target.may_be ||
        grid.target.may_be(grid.target.target_from_source.heading_rad + step * heading_step_rad_);
    grid.looked_at.push_back(grid.looked_at.back() + (is_looked_at ? 1 : 0));
  }
  grids_.push_back(std::move(grid));
  const Grid& added = grids_.back();
  const std::int32_t side = 1 << level;
  for (std::int32_t heading = -added.half_headings; heading <= added.half_headings;
       heading += ScorePyramid::headings_of(level)) {
    for (std::int32_t row = -added.half_rows; row <= added.half_rows; row += side) {
      for (std::int32_t column = -added.half_columns; column <= added.half_columns;
           column += side) {
        offer({.target = static_cast<std::uint32_t>(grids_.size() - 1),
               .level = level,
               .heading = heading,
               .column = column,
               .row = row});
      }
    }
  }
  return work_ - work_before;
}

std::uint64_t WideSearch::advance(std::uint64_t most_work) {
  const std::uint64_t work_before = work_;
  while (!is_done_ && work_ - work_before < most_work) {
    if (queue_.empty() || queue_.front().bound < least_bound_ ||
        peaks_.size() >= config_.max_peaks) {
      is_done_ = true;
      break;
    }
    std::pop_heap(queue_.begin(), queue_.end(), is_after);
    const Block block = queue_.back();
    queue_.pop_back();
    ++work_;
    if (!may_hold_a_new_peak(block)) continue;
    if (block.level == 0) take_leaf(block);
    else expand(block);
  }
  if (is_done_) std::vector<Block>().swap(queue_);
  return work_ - work_before;
}

/// Total order, independent of the heap: among equal bounds the finest block, then the first.
bool WideSearch::is_after(const Block& a, const Block& b) {
  if (a.bound != b.bound) return a.bound < b.bound;
  return std::tie(a.level, a.target, a.heading, a.row, a.column) >
         std::tie(b.level, b.target, b.heading, b.row, b.column);
}

const CellPoints& WideSearch::turned(std::uint32_t target, double heading_steps) {
  const Grid& grid = grids_[target];
  const ScorePyramid& pyramid = *grid.target.pyramid;
  const Pose2& middle = grid.target.target_from_source;
  if (turned_for_ == std::pair{target, heading_steps} && !turned_.columns.empty()) return turned_;
  turned_for_ = {target, heading_steps};
  const Vector2 at = pyramid.in_cells(middle.translation_m());
  const double heading_rad = middle.heading_rad + heading_steps * heading_step_rad_;
  const double cosine = std::cos(heading_rad) / cell_m_;
  const double sine = std::sin(heading_rad) / cell_m_;
  turned_.columns.resize(points_m_.size());
  turned_.rows.resize(points_m_.size());
  std::int32_t* const columns = turned_.columns.data();
  std::int32_t* const rows = turned_.rows.data();
  for (std::size_t i = 0; i < points_m_.size(); ++i) {
    const double x_m = points_m_[i].x();
    const double y_m = points_m_[i].y();
    columns[i] = floored(cosine * x_m - sine * y_m + at.x());
    rows[i] = floored(sine * x_m + cosine * y_m + at.y());
  }
  work_ += kTurnWork * points_m_.size();
  return turned_;
}

/// Middle heading of the block, in steps.
double WideSearch::middle_of(const Block& block) {
  return block.heading + 0.5 * (ScorePyramid::headings_of(block.level) - 1);
}

std::uint32_t WideSearch::bound_of(const Block& block) {
  const CellPoints& points = turned(block.target, middle_of(block));
  work_ += points_m_.size();
  return grids_[block.target].target.pyramid->sum(points, block.column, block.row, block.level);
}

/// Cost of the prior at the block's pose nearest to the middle of the window.
std::uint32_t WideSearch::least_cost_of(const Block& block) const {
  if (config_.border_cost == 0.0) return 0;
  const Grid& grid = grids_[block.target];
  const auto nearest = [](std::int32_t first, std::int32_t count, std::int32_t half_width) {
    const std::int32_t steps = first > 0 ? first : std::max(-(first + count - 1), 0);
    return half_width == 0 ? 0.0 : static_cast<double>(steps) / half_width;
  };
  const std::int32_t side = 1 << block.level;
  const double column = nearest(block.column, side, grid.half_columns);
  const double row = nearest(block.row, side, grid.half_rows);
  const double heading =
      nearest(block.heading, ScorePyramid::headings_of(block.level), grid.half_headings);
  const double full = SmearKernel::kFull * static_cast<double>(points_m_.size());
  return static_cast<std::uint32_t>(config_.border_cost * full *
                                    (column * column + row * row + heading * heading));
}

bool WideSearch::has_heading(const Block& block) const {
  const Grid& grid = grids_[block.target];
  const std::int32_t first = block.heading + grid.half_headings;
  const std::int32_t end =
      std::min(first + ScorePyramid::headings_of(block.level), 2 * grid.half_headings + 1);
  return grid.looked_at[static_cast<std::size_t>(end)] >
         grid.looked_at[static_cast<std::size_t>(first)];
}

void WideSearch::offer(const Block& block) {
  if (has_heading(block)) offer(block, bound_of(block));
}

void WideSearch::offer(const Block& block, std::uint32_t score) {
  Block bounded = block;
  bounded.bound = score - std::min(score, least_cost_of(block));
  if (score < least_score_ || bounded.bound < least_bound_) return;
  queue_.push_back(bounded);
  std::push_heap(queue_.begin(), queue_.end(), is_after);
}

void WideSearch::expand(const Block& block) {
  const Grid& grid = grids_[block.target];
  const std::int32_t half = 1 << (block.level - 1);
  const std::int32_t headings = ScorePyramid::headings_of(block.level - 1);
  for (std::int32_t heading = block.heading;
       heading < block.heading + ScorePyramid::headings_of(block.level); heading += headings) {
    Block child{.target = block.target,
                .level = block.level - 1,
                .heading = heading,
                .column = block.column,
                .row = block.row};
    if (heading > grid.half_headings || !has_heading(child)) continue;
    const auto scores = grid.target.pyramid->sums_of_four(
        turned(child.target, middle_of(child)), block.column, block.row, half, child.level);
    for (std::size_t i = 0; i < scores.size(); ++i) {
      child.column = block.column + (i % 2 == 1 ? half : 0);
      child.row = block.row + (i >= 2 ? half : 0);
      if (child.row > grid.half_rows || child.column > grid.half_columns) continue;
      work_ += points_m_.size();
      offer(child, scores[i]);
    }
  }
}

void WideSearch::take_leaf(const Block& leaf) {
  if (!is_local_maximum(leaf)) return;
  const Grid& grid = grids_[leaf.target];
  const double full = SmearKernel::kFull * static_cast<double>(points_m_.size());
  peaks_.push_back(
      {leaf.target, pose_at(grid, leaf.heading, leaf.column, leaf.row), bound_of(leaf) / full});
  least_bound_ = std::max(least_bound_, config_.min_peak_ratio * leaf.bound);
}

/// A block with all poses near a known peak is skipped.
bool WideSearch::may_hold_a_new_peak(const Block& block) const {
  const Grid& grid = grids_[block.target];
  const double half_side = 0.5 * ((1 << block.level) - 1);
  const double half_headings = 0.5 * (ScorePyramid::headings_of(block.level) - 1);
  const Pose2 middle =
      grid.target.common_from_target *
      pose_at(grid, block.heading + half_headings, block.column + half_side, block.row + half_side);
  const double radius_m = std::numbers::sqrt2 * half_side * cell_m_;
  const double radius_rad = half_headings * heading_step_rad_;
  return std::none_of(peaks_.begin(), peaks_.end(), [&](const WidePeak& peak) {
    const Pose2 known = grids_[peak.target].target.common_from_target * peak.target_from_source;
    const double turned_rad =
        std::abs(geometry::wrap_angle(known.heading_rad - middle.heading_rad));
    return (known.translation_m() - middle.translation_m()).norm() + radius_m <=
               config_.peak_separation_m &&
           turned_rad + radius_rad <= config_.peak_separation_rad;
  });
}

bool WideSearch::is_local_maximum(const Block& leaf) {
  const Grid& grid = grids_[leaf.target];
  const std::uint32_t score = bound_of(leaf);
  for (const std::int32_t heading : {leaf.heading, leaf.heading - 1, leaf.heading + 1}) {
    for (std::int32_t row = leaf.row - 1; row <= leaf.row + 1; ++row) {
      for (std::int32_t column = leaf.column - 1; column <= leaf.column + 1; ++column) {
        const bool is_within = std::abs(heading) <= grid.half_headings &&
                               std::abs(row) <= grid.half_rows &&
                               std::abs(column) <= grid.half_columns;
        if (!is_within) continue;
        if (bound_of({.target = leaf.target, .heading = heading, .column = column, .row = row}) >
            score)
          return false;
      }
    }
  }
  return true;
}

Pose2 WideSearch::pose_at(const Grid& grid, double heading, double column, double row) const {
  const Pose2& middle = grid.target.target_from_source;
  return {middle.x_m + cell_m_ * column, middle.y_m + cell_m_ * row,
          geometry::wrap_angle(middle.heading_rad + heading * heading_step_rad_)};
}

}  // namespace slammot::matching
