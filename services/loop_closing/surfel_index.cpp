#include "services/loop_closing/surfel_index.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::loop_closing {
namespace {

constexpr float kLeastCosine = 0.7F;  // Cosine of the greatest angle between normals of one wall.

bool normals_agree(const flow::Surfel& surfel, const Eigen::Vector2f& normal) {
  const bool either_has_no_normal =
      (surfel.normal_x == 0.0F && surfel.normal_y == 0.0F) || normal.isZero();
  // The sign of a normal is arbitrary.
  return either_has_no_normal ||
         std::abs(surfel.normal_x * normal.x() + surfel.normal_y * normal.y()) >= kLeastCosine;
}

}  // namespace

SurfelIndex::SurfelIndex(std::vector<flow::Surfel> surfels, double bucket_m)
    : bucket_m_(static_cast<float>(bucket_m)) {
  first_.assign(1, 0);
  if (surfels.empty()) return;
  const auto [low_x, high_x] = std::minmax_element(surfels.begin(), surfels.end(),
                                                   [](auto& a, auto& b) { return a.x_m < b.x_m; });
  const auto [low_y, high_y] = std::minmax_element(surfels.begin(), surfels.end(),
                                                   [](auto& a, auto& b) { return a.y_m < b.y_m; });
  min_x_m_ = low_x->x_m;
  min_y_m_ = low_y->y_m;
  columns_ = static_cast<std::int32_t>((high_x->x_m - min_x_m_) / bucket_m_) + 1;
  rows_ = static_cast<std::int32_t>((high_y->y_m - min_y_m_) / bucket_m_) + 1;
  const auto bucket_of = [&](const flow::Surfel& surfel) {
    return static_cast<std::size_t>(row_of(surfel.y_m)) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column_of(surfel.x_m));
  };
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const flow::Surfel& surfel : surfels) ++first_[bucket_of(surfel) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  surfels_.resize(surfels.size());
  for (const flow::Surfel& surfel : surfels) surfels_[next[bucket_of(surfel)]++] = surfel;
}

std::int32_t SurfelIndex::column_of(float x_m) const {
  return static_cast<std::int32_t>(std::floor((x_m - min_x_m_) / bucket_m_));
}
std::int32_t SurfelIndex::row_of(float y_m) const {
  return static_cast<std::int32_t>(std::floor((y_m - min_y_m_) / bucket_m_));
}

const flow::Surfel* SurfelIndex::nearest(const Eigen::Vector2f& point_m,
                                         const Eigen::Vector2f& normal, float reach_m) const {
  const std::int32_t low_row = std::max(row_of(point_m.y() - reach_m), 0);
  const std::int32_t high_row = std::min(row_of(point_m.y() + reach_m), rows_ - 1);
  const std::int32_t low_column = std::max(column_of(point_m.x() - reach_m), 0);
  const std::int32_t high_column = std::min(column_of(point_m.x() + reach_m), columns_ - 1);
  if (low_column > high_column) return nullptr;
  const flow::Surfel* best = nullptr;
  float best_m2 = reach_m * reach_m;
  for (std::int32_t row = low_row; row <= high_row; ++row) {
    const std::size_t bucket = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
    const std::uint32_t end = first_[bucket + static_cast<std::size_t>(high_column) + 1];
    for (std::uint32_t i = first_[bucket + static_cast<std::size_t>(low_column)]; i < end; ++i) {
      const flow::Surfel& surfel = surfels_[i];
      const float dx = surfel.x_m - point_m.x();
      const float dy = surfel.y_m - point_m.y();
      const float distance_m2 = dx * dx + dy * dy;
      if (distance_m2 >= best_m2 || !normals_agree(surfel, normal)) continue;
      best_m2 = distance_m2;
      best = &surfel;
    }
  }
  return best;
}

}  // namespace slammot::loop_closing
