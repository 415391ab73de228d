#include "common/matching/correlative.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "common/matching/search_grid.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kFull = SmearKernel::kFull;

/// target(x, y) = max over {x, x + step} x {y, y + step} of source; values beyond the end count as
/// 0.
void widen_maximum(const std::vector<std::uint8_t>& source, std::int32_t columns, std::int32_t rows,
                   std::int32_t step, std::vector<std::uint8_t>& target) {
  target.resize(source.size());
  for (std::int32_t row = 0; row < rows; ++row) {
    const std::uint8_t* here = source.data() + static_cast<std::ptrdiff_t>(row) * columns;
    const std::uint8_t* above =
        row + step < rows ? here + static_cast<std::ptrdiff_t>(step) * columns : here;
    std::uint8_t* out = target.data() + static_cast<std::ptrdiff_t>(row) * columns;
    for (std::int32_t column = 0; column < columns; ++column)
      out[column] = std::max(here[column], above[column]);
    for (std::int32_t column = 0; column + step < columns; ++column) {
      out[column] = std::max(out[column], out[column + step]);
    }
  }
}

}  // namespace

CorrelativeMatcher::CorrelativeMatcher(const CorrelativeConfig& config)
    : config_(config),
      kernel_(config.resolution_m, config.smear_sigma_m),
      kernel_half_(kernel_.half()) {
  assert(config_.resolution_m > 0.0 && config_.smear_sigma_m > 0.0);
}

const std::uint8_t* CorrelativeMatcher::kernel_for(const Vector2& point_in_target_m,
                                                   const Cell& cell) const {
  return kernel_.around({(point_in_target_m.x() - min_x_m_) / config_.resolution_m - cell.column,
                         (point_in_target_m.y() - min_y_m_) / config_.resolution_m - cell.row});
}

void CorrelativeMatcher::set_target(std::span<const TargetPoint> points,
                                    const TargetRegion& region) {
  lay_out(region);
  stamp(points);
  build_pyramid();
}

void CorrelativeMatcher::lay_out(const TargetRegion& region) {
  const double cell_m = config_.resolution_m;
  largest_shift_ = steps_within(region.largest_shift_m, cell_m);
  top_level_ = useful_level(largest_shift_);
  // A point may lie one shift outside the region and be shifted once more, and a block extends one
  // side further.
  pad_ = 2 * largest_shift_ + (1 << top_level_);
  const std::int32_t half_columns = steps_within(region.half_width_m, cell_m);
  const std::int32_t half_rows = steps_within(region.half_height_m, cell_m);
  columns_ = 2 * (half_columns + pad_);
  rows_ = 2 * (half_rows + pad_);
  min_x_m_ = region.centre_m.x() - cell_m * (half_columns + pad_);
  min_y_m_ = region.centre_m.y() - cell_m * (half_rows + pad_);
  pyramid_.resize(static_cast<std::size_t>(top_level_) + 1);
  pyramid_.front().assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
}

void CorrelativeMatcher::stamp(std::span<const TargetPoint> points) {
  const std::int32_t side = 2 * kernel_half_ + 1;
  for (const TargetPoint& point : points) {
    const Vector2 point_in_target_m(point.x_m, point.y_m);
    const Cell cell = cell_of(point_in_target_m);
    const bool smears_into_region =
        cell.column + kernel_half_ >= pad_ && cell.column - kernel_half_ < columns_ - pad_ &&
        cell.row + kernel_half_ >= pad_ && cell.row - kernel_half_ < rows_ - pad_;
    if (!smears_into_region) continue;
    const std::uint8_t* kernel = kernel_for(point_in_target_m, cell);
    const std::uint32_t weight_256 =
        static_cast<std::uint32_t>(std::lround(256.0F * std::clamp(point.weight, 0.0F, 1.0F)));
    // Only the region is filled. The padding stays zero, so that any shift can be read safely.
    const std::int32_t first_column = std::max(cell.column - kernel_half_, pad_);
    const std::int32_t last_column = std::min(cell.column + kernel_half_, columns_ - pad_ - 1);
    const std::int32_t first_row = std::max(cell.row - kernel_half_, pad_);
    const std::int32_t last_row = std::min(cell.row + kernel_half_, rows_ - pad_ - 1);
    for (std::int32_t row = first_row; row <= last_row; ++row) {
      const std::uint8_t* kernel_row = kernel + (row - cell.row + kernel_half_) * side;
      std::uint8_t* cells = pyramid_.front().data() + static_cast<std::ptrdiff_t>(row) * columns_;
      for (std::int32_t column = first_column; column <= last_column; ++column) {
        const std::uint32_t value =
            (kernel_row[column - cell.column + kernel_half_] * weight_256) >> 8;
        cells[column] = std::max(cells[column], static_cast<std::uint8_t>(value));
      }
    }
  }
}

void CorrelativeMatcher::build_pyramid() {
  for (std::size_t level = 1; level < pyramid_.size(); ++level) {
    widen_maximum(pyramid_[level - 1], columns_, rows_, 1 << (level - 1), pyramid_[level]);
  }
}

CorrelativeMatcher::Cell CorrelativeMatcher::cell_of(const Vector2& point_in_target_m) const {
  // The clamp keeps the conversion to integers defined; cells far outside are equivalent.
  const auto index = [](double cells) {
    return static_cast<std::int32_t>(std::floor(std::clamp(cells, -1e8, 1e8)));
  };
  return {index((point_in_target_m.x() - min_x_m_) / config_.resolution_m),
          index((point_in_target_m.y() - min_y_m_) / config_.resolution_m)};
}

std::vector<Peak> CorrelativeMatcher::search(std::span<const Eigen::Vector2f> points_in_source_m,
                                             const Pose2& target_from_source,
                                             const SearchWindow& window) {
  std::vector<Peak> peaks;
  if (points_in_source_m.empty() || pyramid_.empty()) return peaks;
  initial_ = target_from_source;
  heading_step_rad_ = heading_step_for(points_in_source_m);
  const Shifts shifts{std::min(steps_within(window.half_x_m, config_.resolution_m), largest_shift_),
                      std::min(steps_within(window.half_y_m, config_.resolution_m), largest_shift_),
                      steps_within(window.half_heading_rad, heading_step_rad_)};
  turn_points(points_in_source_m, target_from_source, shifts);
  collect_top_blocks(shifts);

  const double full_sum = kFull * static_cast<double>(points_in_source_m.size());
  double threshold = config_.min_score * full_sum;
  found_.clear();
  while (peaks.size() < config_.max_peaks) {
    Block best{.bound = static_cast<std::uint32_t>(std::max(std::ceil(threshold) - 1.0, 0.0))};
    const std::uint32_t to_beat = best.bound;
    for (const Block& block : top_blocks_) {
      if (block.bound <= best.bound) break;
      descend(block, top_level_, shifts, best);
    }
    if (best.bound == to_beat) break;
    found_.push_back(best);
    peaks.push_back({pose_of(best), best.bound / full_sum});
    threshold = std::max(threshold, config_.min_peak_ratio * found_.front().bound);
  }
  return peaks;
}

double CorrelativeMatcher::heading_step_for(std::span<const Eigen::Vector2f> points) const {
  if (config_.heading_step_rad > 0.0) return config_.heading_step_rad;
  float furthest_m = 0.0F;
  for (const Eigen::Vector2f& point : points) furthest_m = std::max(furthest_m, point.norm());
  return config_.resolution_m / std::max(static_cast<double>(furthest_m), config_.resolution_m);
}

void CorrelativeMatcher::turn_points(std::span<const Eigen::Vector2f> points, const Pose2& initial,
                                     const Shifts& shifts) {
  headings_.clear();
  offsets_.clear();
  for (std::int32_t step = -shifts.headings; step <= shifts.headings; ++step) {
    TurnedPoints turned{.heading_offset_rad = step * heading_step_rad_,
                        .first = static_cast<std::uint32_t>(offsets_.size())};
    const Pose2 pose{initial.x_m, initial.y_m, initial.heading_rad + turned.heading_offset_rad};
    const Eigen::Matrix2d rotation = geometry::rotation(pose.heading_rad);
    for (const Eigen::Vector2f& point : points) {
      const Cell cell = cell_of(rotation * point.cast<double>() + pose.translation_m());
      // A point this far out cannot be shifted into the region and scores 0 in the whole window.
      const bool reachable =
          cell.column >= pad_ - shifts.columns && cell.column < columns_ - pad_ + shifts.columns &&
          cell.row >= pad_ - shifts.rows && cell.row < rows_ - pad_ + shifts.rows;
      if (reachable) offsets_.push_back(cell.row * columns_ + cell.column);
    }
    turned.count = static_cast<std::uint32_t>(offsets_.size()) - turned.first;
    headings_.push_back(turned);
  }
}

void CorrelativeMatcher::collect_top_blocks(const Shifts& shifts) {
  top_blocks_.clear();
  const std::int32_t side = 1 << top_level_;
  for (std::uint32_t heading = 0; heading < headings_.size(); ++heading) {
    for (std::int32_t row = -shifts.rows; row <= shifts.rows; row += side) {
      for (std::int32_t column = -shifts.columns; column <= shifts.columns; column += side) {
        top_blocks_.push_back({bound_of(heading, column, row, top_level_), heading, column, row});
      }
    }
  }
  // Stable sort: the order of equal bounds, and therefore the result, is deterministic.
  std::stable_sort(top_blocks_.begin(), top_blocks_.end(),
                   [](const Block& a, const Block& b) { return a.bound > b.bound; });
}

std::uint32_t CorrelativeMatcher::bound_of(std::uint32_t heading, std::int32_t column,
                                           std::int32_t row, int level) const {
  const TurnedPoints& turned = headings_[heading];
  const std::uint8_t* cells =
      pyramid_[static_cast<std::size_t>(level)].data() + (row * columns_ + column);
  const std::int32_t* offsets = offsets_.data() + turned.first;
  std::uint32_t sum = 0;
  for (std::uint32_t i = 0; i < turned.count; ++i) sum += cells[offsets[i]];
  return sum;
}

void CorrelativeMatcher::descend(const Block& block, int level, const Shifts& shifts,
                                 Block& best) const {
  if (!may_hold_a_new_peak(block, level)) return;
  if (level == 0) {
    if (found_.empty() || is_local_maximum(block, shifts)) best = block;
    return;
  }
  const std::int32_t half = 1 << (level - 1);
  std::array<Block, 4> children;
  std::size_t count = 0;
  for (const std::int32_t row : {block.row, block.row + half}) {
    for (const std::int32_t column : {block.column, block.column + half}) {
      if (row > shifts.rows || column > shifts.columns) continue;
      children[count++] = {bound_of(block.heading, column, row, level - 1), block.heading, column,
                           row};
    }
  }
  std::stable_sort(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(count),
                   [](const Block& a, const Block& b) { return a.bound > b.bound; });
  for (std::size_t i = 0; i < count && children[i].bound > best.bound; ++i) {
    descend(children[i], level - 1, shifts, best);
  }
}

bool CorrelativeMatcher::may_hold_a_new_peak(const Block& block, int level) const {
  const std::int32_t far_side = (1 << level) - 1;
  const double cell_m = config_.resolution_m;
  return std::none_of(found_.begin(), found_.end(), [&](const Block& peak) {
    const auto furthest = [&](std::int32_t from, std::int32_t to) {
      return cell_m * std::max(std::abs(from - to), std::abs(from + far_side - to));
    };
    const double turned_rad =
        heading_step_rad_ * std::abs(static_cast<double>(block.heading) - peak.heading);
    return turned_rad <= config_.peak_separation_rad &&
           furthest(block.column, peak.column) <= config_.peak_separation_m &&
           furthest(block.row, peak.row) <= config_.peak_separation_m;
  });
}

bool CorrelativeMatcher::is_local_maximum(const Block& leaf, const Shifts& shifts) const {
  const auto rises_towards = [&](int turn, int column_step, int row_step) {
    const std::int32_t column = leaf.column + column_step;
    const std::int32_t row = leaf.row + row_step;
    const std::int64_t heading = static_cast<std::int64_t>(leaf.heading) + turn;
    if (std::abs(column) > shifts.columns || std::abs(row) > shifts.rows) return false;
    if (heading < 0 || heading >= static_cast<std::int64_t>(headings_.size())) return false;
    return bound_of(static_cast<std::uint32_t>(heading), column, row, 0) > leaf.bound;
  };
  for (int turn = -1; turn <= 1; ++turn) {
    for (int row_step = -1; row_step <= 1; ++row_step) {
      for (int column_step = -1; column_step <= 1; ++column_step) {
        if (rises_towards(turn, column_step, row_step)) return false;
      }
    }
  }
  return true;
}

Pose2 CorrelativeMatcher::pose_of(const Block& leaf) const {
  return {initial_.x_m + config_.resolution_m * leaf.column,
          initial_.y_m + config_.resolution_m * leaf.row,
          geometry::wrap_angle(initial_.heading_rad + headings_[leaf.heading].heading_offset_rad)};
}

double CorrelativeMatcher::score(std::span<const Eigen::Vector2f> points_in_source_m,
                                 const Pose2& target_from_source) const {
  if (points_in_source_m.empty() || pyramid_.empty()) return 0.0;
  const Eigen::Matrix2d rotation = geometry::rotation(target_from_source.heading_rad);
  std::uint32_t sum = 0;
  for (const Eigen::Vector2f& point : points_in_source_m) {
    const Cell cell = cell_of(rotation * point.cast<double>() + target_from_source.translation_m());
    const bool inside =
        static_cast<std::uint32_t>(cell.column) < static_cast<std::uint32_t>(columns_) &&
        static_cast<std::uint32_t>(cell.row) < static_cast<std::uint32_t>(rows_);
    if (inside)
      sum +=
          pyramid_.front()[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns_) +
                           static_cast<std::size_t>(cell.column)];
  }
  return sum / (kFull * static_cast<double>(points_in_source_m.size()));
}

}  // namespace slammot::matching
