#include "services/loop_closing/georeferencing.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "common/flow/georeference_verdict.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Matrix2;
using graphs::AbsoluteFit;
using graphs::AbsolutePriors;
using graphs::BentGraph;

constexpr double kLeastVariance_m2 = 0.01;
constexpr double kLeastSigma_rad = 0.005;
constexpr double kMostSigma = 1e4;
/// Sum of squared errors that bending must save: less is explained by errors of the fixes that last
/// (docs/decisions/loop-closing.md).
constexpr double kSavedByBending = 25.0;
constexpr int kMostBends = 3;
/// Error of fixes that multipath does not explain, in claimed sigmas and in metres. Between houses
/// of 24 m it is 1.3 times what is claimed and 7 m; with latitude and longitude swapped, 7 times
/// and 39 m; with wrong signs, 15 times and 83 m.
constexpr double kAbsurdScale = 5.0;
constexpr double kAbsurdSigma_m = 20.0;

Matrix2 covariance_of(const flow::SubmapFix& fix) {
  const auto bounded = [](float variance_m2) {
    return std::clamp(double{variance_m2}, kLeastVariance_m2, kMostSigma * kMostSigma);
  };
  const double east_m2 = bounded(fix.east_variance_m2);
  const double north_m2 = bounded(fix.north_variance_m2);
  const double most_m2 = 0.9 * std::sqrt(east_m2 * north_m2);
  const double both_m2 = std::clamp(double{fix.covariance_m2}, -most_m2, most_m2);
  Matrix2 covariance_m2;
  covariance_m2 << east_m2, both_m2, both_m2, north_m2;
  return covariance_m2;
}

double mean_sigma_m(const std::vector<graphs::PositionPrior>& priors) {
  double sum_m2 = 0.0;
  for (const graphs::PositionPrior& prior : priors) sum_m2 += 0.5 * prior.covariance_m2.trace();
  return priors.empty() ? 0.0 : std::sqrt(sum_m2 / static_cast<double>(priors.size()));
}

bool contradict_map(const AbsoluteFit& fit, const AbsolutePriors& priors) {
  return fit.has_position && fit.positions.scale > kAbsurdScale &&
         fit.positions.scale * mean_sigma_m(priors.positions) > kAbsurdSigma_m;
}

/// The measurements without those that are absurd beside the others. The bias of a compass is
/// judged by GNSS that agrees with the map.
AbsolutePriors sound_ones(const AbsolutePriors& priors, const AbsoluteFit& fit) {
  AbsolutePriors sound = priors;
  if (contradict_map(fit, priors)) {
    sound.positions.clear();
  } else if (std::abs(fit.heading_bias_rad) > flow::kMostCompassBias_rad) {
    sound.headings.clear();
  }
  return sound;
}

/// A fit to the sound measurements, with what the fit to all says of the others.
AbsoluteFit with_errors_of_others(AbsoluteFit fit, const AbsolutePriors& sound,
                                  const AbsoluteFit& to_all) {
  if (sound.positions.empty()) fit.positions = to_all.positions;
  if (sound.headings.empty()) {
    fit.headings = to_all.headings;
    fit.heading_bias_rad = to_all.heading_bias_rad;
  }
  return fit;
}

/// Bends the graph and looks again which measurements are outliers, some times.
std::optional<BentGraph> bent(const std::vector<flow::CorrectedSubmap>& connected,
                              const std::vector<flow::Constraint>& constraints,
                              const AbsolutePriors& priors, const AbsoluteFit& rigid) {
  std::optional<BentGraph> best;
  AbsoluteFit fit = rigid;
  for (int time = 0; time < kMostBends; ++time) {
    auto next = graphs::bend(connected, constraints, priors, fit);
    if (!next) return best;
    if (next->cost_saved < kSavedByBending) return best;
    fit = graphs::align(next->nodes, priors);
    next->fit = fit;
    best = std::move(next);
  }
  return best;
}

}  // namespace

void Georeferencing::add(const flow::Submap& submap) {
  for (const flow::SubmapFix& fix : submap.fixes) {
    if (!enu_origin_) enu_origin_ = fix.position;
    const geometry::Vector2 in_enu_m = geometry::east_north_m(*enu_origin_, fix.position);
    if (in_enu_m.allFinite())
      priors_.positions.push_back(
          {submap.submap_id, {fix.x_m, fix.y_m}, in_enu_m, covariance_of(fix)});
  }
  for (const flow::SubmapHeading& heading : submap.headings) {
    priors_.headings.push_back(
        {submap.submap_id, heading.in_submap_rad, heading.from_east_rad,
         std::clamp(double{heading.sigma_rad}, kLeastSigma_rad, kMostSigma)});
  }
}

AbsolutePriors Georeferencing::priors_of(
    const std::vector<flow::CorrectedSubmap>& connected) const {
  std::set<flow::SubmapId> known;
  for (const flow::CorrectedSubmap& submap : connected) known.insert(submap.submap_id);
  const auto is_known = [&](const auto& prior) { return known.contains(prior.node); };
  AbsolutePriors priors;
  std::ranges::copy_if(priors_.positions, std::back_inserter(priors.positions), is_known);
  std::ranges::copy_if(priors_.headings, std::back_inserter(priors.headings), is_known);
  return priors;
}

flow::Georeference Georeferencing::georeference_of(const AbsoluteFit& fit,
                                                   const AbsolutePriors& priors) const {
  flow::Georeference reference;
  reference.has_position = fit.has_position;
  reference.has_direction = fit.has_direction;
  if (fit.has_position)
    reference.origin = geometry::geodetic_at(*enu_origin_, fit.enu_from_map.translation_m());
  reference.x_from_east_rad = fit.enu_from_map.heading_rad;
  reference.position_sigma_m = fit.position_sigma_m;
  reference.direction_sigma_rad = fit.direction_sigma_rad;
  reference.compass_bias_rad = fit.heading_bias_rad;
  if (fit.positions.inliers() > 0)
    reference.fix_sigma_m = fit.positions.scale * mean_sigma_m(priors.positions);
  reference.fixes = static_cast<std::uint32_t>(priors.positions.size());
  reference.headings = static_cast<std::uint32_t>(priors.headings.size());
  if (fit.has_position)
    reference.rejected_fixes =
        static_cast<std::uint32_t>(priors.positions.size() - fit.positions.inliers());
  if (fit.headings.inliers() > 0)
    reference.rejected_headings =
        static_cast<std::uint32_t>(priors.headings.size() - fit.headings.inliers());
  return reference;
}

std::optional<Georeferencing::Result> Georeferencing::compare(
    const std::vector<flow::CorrectedSubmap>& connected,
    const std::function<std::vector<flow::Constraint>()>& constraints) const {
  if (priors_.positions.empty() && priors_.headings.empty()) return std::nullopt;
  const AbsolutePriors priors = priors_of(connected);
  if (priors.positions.empty() && priors.headings.empty()) return std::nullopt;
  const AbsoluteFit to_all = graphs::align(connected, priors);
  const AbsolutePriors sound = sound_ones(priors, to_all);
  const bool are_all_sound = sound.positions.size() == priors.positions.size() &&
                             sound.headings.size() == priors.headings.size();
  const AbsoluteFit rigid = are_all_sound ? to_all : graphs::align(connected, sound);
  Result result{connected, georeference_of(with_errors_of_others(rigid, sound, to_all), priors)};
  if (!rigid.has_position && !rigid.has_direction) return result;
  if (auto better = bent(connected, constraints(), sound, rigid)) {
    result.submaps = std::move(better->nodes);
    result.georeference =
        georeference_of(with_errors_of_others(better->fit, sound, to_all), priors);
    result.georeference.corrects_map = true;
  }
  return result;
}

}  // namespace slammot::loop_closing
