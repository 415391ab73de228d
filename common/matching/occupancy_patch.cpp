#include "common/matching/occupancy_patch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace slammot::matching {

using geometry::Matrix2;
using geometry::Vector2;

namespace {

constexpr double kSigmas = 3.0;  // farther cells are not affected by a measurement
constexpr double kSurest = 0.9;  // upper limit of the evidence of a single echo

Vector2 reach_m(const UncertainPoint& point, double cell_size_m) {
  return kSigmas * point.covariance_m2.diagonal().cwiseSqrt() + Vector2::Constant(cell_size_m);
}

}  // namespace

OccupancyPatch::OccupancyPatch(std::span<const UncertainPoint> points, double cell_size_m) {
  assert(cell_size_m > 0.0);
  window_.cell_size_m = cell_size_m;
  if (points.empty()) return;
  Eigen::AlignedBox2d box;
  for (const UncertainPoint& point : points) {
    box.extend(Vector2(point.mean_m - reach_m(point, cell_size_m)));
    box.extend(Vector2(point.mean_m + reach_m(point, cell_size_m)));
  }
  window_.first = window_.cell_at(box.min().x(), box.min().y());
  const grids::Cell last = window_.cell_at(box.max().x(), box.max().y());
  window_.columns = last.column - window_.first.column + 1;
  window_.rows = last.row - window_.first.row + 1;
  log_odds_.assign(window_.cell_count(), 0.0F);
  for (const UncertainPoint& point : points) add_log_odds(point);
  evidence_.reserve(log_odds_.size());
  for (const float log_odds : log_odds_) evidence_.push_back(std::tanh(0.5F * log_odds));
}

void OccupancyPatch::add_log_odds(const UncertainPoint& point) {
  const double cell_m = window_.cell_size_m;
  // Approximates the mean of the density over a cell by a Gaussian whose variance includes the
  // cell's width.
  const Matrix2 covariance_m2 = point.covariance_m2 + cell_m * cell_m / 12.0 * Matrix2::Identity();
  const Matrix2 information = covariance_m2.inverse();
  const double highest =
      cell_m * cell_m / (2.0 * std::numbers::pi * std::sqrt(covariance_m2.determinant()));
  const Vector2 reach = reach_m(point, cell_m);
  const grids::Cell low =
      window_.cell_at(point.mean_m.x() - reach.x(), point.mean_m.y() - reach.y());
  const grids::Cell high =
      window_.cell_at(point.mean_m.x() + reach.x(), point.mean_m.y() + reach.y());
  for (std::int32_t row = low.row; row <= high.row; ++row) {
    for (std::int32_t column = low.column; column <= high.column; ++column) {
      const Vector2 away_m = window_.centre_of({column, row}) - point.mean_m;
      const double evidence =
          std::min(kSurest, highest * std::exp(-0.5 * away_m.dot(information * away_m)));
      log_odds_[window_.index({column, row})] += static_cast<float>(2.0 * std::atanh(evidence));
    }
  }
}

double OccupancyPatch::evidence(std::int32_t column, std::int32_t row) const {
  const grids::Cell cell{column, row};
  return window_.contains(cell) ? static_cast<double>(evidence_[window_.index(cell)]) : 0.0;
}

double OccupancyPatch::evidence_at(const Vector2& point_m) const {
  const Vector2 in_cells = point_m / window_.cell_size_m - Vector2::Constant(0.5);
  const Vector2 low = in_cells.array().floor();
  const auto column = static_cast<std::int32_t>(low.x());
  const auto row = static_cast<std::int32_t>(low.y());
  const Vector2 share = in_cells - low;
  return (1.0 - share.y()) *
             ((1.0 - share.x()) * evidence(column, row) + share.x() * evidence(column + 1, row)) +
         share.y() * ((1.0 - share.x()) * evidence(column, row + 1) +
                      share.x() * evidence(column + 1, row + 1));
}

std::vector<OccupiedCell> OccupancyPatch::occupied(double least_evidence) const {
  std::vector<OccupiedCell> cells;
  for (std::int32_t row = 0; row < window_.rows; ++row) {
    for (std::int32_t column = 0; column < window_.columns; ++column) {
      const grids::Cell cell{window_.first.column + column, window_.first.row + row};
      const auto evidence = static_cast<double>(evidence_[window_.index(cell)]);
      if (evidence >= least_evidence) cells.push_back({window_.centre_of(cell), evidence});
    }
  }
  return cells;
}

double correlation(const OccupancyPatch& target, std::span<const OccupiedCell> source,
                   const geometry::Pose2& target_from_source) {
  const Matrix2 turn = geometry::rotation(target_from_source.heading_rad);
  double products = 0.0;
  double sum = 0.0;
  for (const OccupiedCell& cell : source) {
    products += cell.evidence *
                target.evidence_at(turn * cell.centre_m + target_from_source.translation_m());
    sum += cell.evidence;
  }
  return sum > 0.0 ? products / sum : 0.0;
}

}  // namespace slammot::matching
