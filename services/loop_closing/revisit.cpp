#include "services/loop_closing/revisit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace slammot::loop_closing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kSameWithinSquaredSigmas = 11.3;  // chi-square, 3 degrees of freedom, 99 %

matching::CorrelativeConfig search_config(const RevisitConfig& config) {
  return {.resolution_m = config.search_cell_m,
          .smear_sigma_m = config.search_cell_m,
          .min_score = config.min_score,
          .max_peaks = static_cast<std::size_t>(config.max_peaks),
          .min_peak_ratio = 0.8 * config.rival_ratio,
          .peak_separation_m = 5.0 * config.search_cell_m,
          .peak_separation_rad = 0.15};
}

std::vector<flow::Surfel> surfels_in_target(const Target& target) {
  std::vector<flow::Surfel> surfels;
  for (const Target::Member& member : target.members) {
    const Eigen::Matrix2d turn = geometry::rotation(member.target_from_member.heading_rad);
    for (const flow::Surfel& surfel : member.place->surfels) {
      const Vector2 at = turn * Vector2(surfel.x_m, surfel.y_m) + member.target_from_member.translation_m();
      const Vector2 normal = turn * Vector2(surfel.normal_x, surfel.normal_y);
      surfels.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(normal.x()),
                         static_cast<float>(normal.y()), surfel.weight});
    }
  }
  return surfels;
}

std::vector<matching::TargetPoint> as_target_points(const std::vector<flow::Surfel>& surfels) {
  std::vector<matching::TargetPoint> points;
  points.reserve(surfels.size());
  for (const flow::Surfel& surfel : surfels) points.push_back({surfel.x_m, surfel.y_m, 1.0F});
  return points;
}

Vector2 centroid_of(const std::vector<flow::Surfel>& surfels) {
  Vector2 sum = Vector2::Zero();
  for (const flow::Surfel& surfel : surfels) sum += Vector2(surfel.x_m, surfel.y_m);
  return sum / static_cast<double>(std::max<std::size_t>(surfels.size(), 1));
}

/// Evenly thinned surfels about their centroid: a turn about it hardly shifts them.
std::vector<Eigen::Vector2f> points_about(const Vector2& centre_m, const std::vector<flow::Surfel>& surfels, int max_points) {
  std::vector<Eigen::Vector2f> points;
  const std::size_t step = surfels.size() / static_cast<std::size_t>(max_points) + 1;
  for (std::size_t i = 0; i < surfels.size(); i += step) {
    points.emplace_back(surfels[i].x_m - static_cast<float>(centre_m.x()), surfels[i].y_m - static_cast<float>(centre_m.y()));
  }
  return points;
}

matching::TargetRegion region_around(const std::vector<flow::Surfel>& surfels, double largest_shift_m) {
  Eigen::AlignedBox2d box;
  for (const flow::Surfel& surfel : surfels) box.extend(Vector2(surfel.x_m, surfel.y_m));
  return {.centre_m = box.center(),
          .half_width_m = 0.5 * box.sizes().x() + 0.5,
          .half_height_m = 0.5 * box.sizes().y() + 0.5,
          .largest_shift_m = largest_shift_m};
}

bool is_astray(const UncertainPose2& expected, const RevisitConfig& config) {
  return expected.covariance(2, 2) > config.any_heading_sigma_rad * config.any_heading_sigma_rad;
}

bool are_same(const UncertainPose2& a, const UncertainPose2& b) {
  const Eigen::Vector3d difference = geometry::difference(a.pose, b.pose);
  return difference.dot(Matrix3(a.covariance + b.covariance).ldlt().solve(difference)) < kSameWithinSquaredSigmas;
}

void keep_best_of_the_same(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& a, const Hypothesis& b) { return a.quality() > b.quality(); });
  std::vector<Hypothesis> kept;
  for (const Hypothesis& hypothesis : hypotheses) {
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& one) { return are_same(one.from_to, hypothesis.from_to); });
    if (!is_known) kept.push_back(hypothesis);
  }
  hypotheses = std::move(kept);
}

void drop_poor_rivals(std::vector<Hypothesis>& hypotheses, double rival_ratio) {
  if (hypotheses.empty()) return;
  const double least_quality = rival_ratio * hypotheses.front().quality();
  std::erase_if(hypotheses, [&](const Hypothesis& one) { return one.quality() < least_quality; });
  for (Hypothesis& hypothesis : hypotheses) hypothesis.has_rivals = hypotheses.size() > 1;
}

}  // namespace

RevisitFinder::RevisitFinder(const RevisitConfig& config) : config_(config), matcher_(search_config(config)) {}

std::vector<matching::Peak> RevisitFinder::search(const Target& target, const Place& source, const UncertainPose2& expected) {
  const auto surfels = surfels_in_target(target);
  const bool astray = is_astray(expected, config_);
  const auto window_m = [&](double variance_m2) {
    return std::clamp(config_.window_sigmas * std::sqrt(variance_m2), config_.min_window_m, astray ? config_.astray_window_m : config_.max_window_m);
  };
  const Vector2 centre_m = centroid_of(source.surfels);
  const Pose2 source_from_centre{centre_m.x(), centre_m.y(), 0.0};
  const UncertainPose2 target_from_centre = geometry::compound(expected, {source_from_centre, Matrix3::Zero()});
  const matching::SearchWindow window{
      window_m(target_from_centre.covariance(0, 0)), window_m(target_from_centre.covariance(1, 1)),
      std::clamp(config_.window_sigmas * std::sqrt(expected.covariance(2, 2)), config_.min_window_rad,
                 astray ? std::numbers::pi : config_.max_window_rad)};
  matcher_.set_target(as_target_points(surfels), region_around(surfels, std::max(window.half_x_m, window.half_y_m)));
  auto peaks = matcher_.search(points_about(centre_m, source.surfels, config_.max_points), target_from_centre.pose, window);
  for (matching::Peak& peak : peaks) {
    peak.target_from_source = geometry::compound(peak.target_from_source, {geometry::inverse(source_from_centre), Matrix3::Zero()});
  }
  return peaks;
}

std::vector<Hypothesis> RevisitFinder::find(const Target& target, const Place& source, const UncertainPose2& expected_target_from_source) {
  std::vector<Hypothesis> hypotheses;
  const SurfelIndex index(surfels_in_target(target), config_.registration.coarse_gate_m);
  if (index.surfels().empty() || source.surfels.empty()) return hypotheses;
  const double least_agreed_share = is_astray(expected_target_from_source, config_) ? config_.min_agreed_in_support : config_.min_agreed_share;
  for (const matching::Peak& peak : search(target, source, expected_target_from_source)) {
    const Registration registration =
        register_surfels(source.surfels, source.spacing_m, index, peak.target_from_source.pose, config_.registration);
    const Hypothesis hypothesis{.from = target.members.front().place->id,
                                .to = source.id,
                                .from_to = registration.target_from_source,
                                .agreement = compare(target, source, registration.target_from_source.pose),
                                .score = peak.score,
                                .searched_sigma_m = std::sqrt(expected_target_from_source.covariance.topLeftCorner<2, 2>().trace())};
    const bool holds = hypothesis.agreement.agreed_share() >= least_agreed_share &&
                       hypothesis.agreement.overlap_share() >= config_.min_overlap_share;
    if (holds) hypotheses.push_back(hypothesis);
  }
  keep_best_of_the_same(hypotheses);
  drop_poor_rivals(hypotheses, config_.rival_ratio);
  return hypotheses;
}

}  // namespace slammot::loop_closing
