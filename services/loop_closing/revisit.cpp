#include "services/loop_closing/revisit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace slammot::loop_closing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kMinScore = 0.35;  // Least score of the search before registration.
constexpr int kMaxPeaks = 4;  // Poses of one search that are registered; twice as many on several
                              // targets.
constexpr int kMaxPoints = 300;               // Surfels of the new submap used in the search.
constexpr double kWindowSigmas = 3.0;         // Half width of the window around the expected pose.
constexpr double kMinWindow_rad = 0.06;       // Least half width of the window of the heading.
constexpr double kMaxWindow_rad = 0.6;        // Greatest half width of the window of the heading.
constexpr double kAnyHeadingSigma_rad = 1.0;  // With a greater one-sigma error of the heading, all
                                              // headings are searched.
constexpr double kMinOverlapShare = 0.3;  // Least share of the new submap's walls that the target
                                          // has too.
constexpr double kMinAgreedInSupport = 0.8;  // With unknown heading, least agreed share of a
                                             // hypothesis that may support others.

// Work of the other steps, in cells that a search reads in the same time.
constexpr std::uint64_t kWorkOfRegisteringSurfel = 400;
constexpr std::uint64_t kWorkOfComparingSurfel = 20;

constexpr double kNearShare = 0.25;  // Share of the full window that is searched first: 1/64 of the
                                     // poses, and most revisits.
constexpr double kBorderCost = 0.1;  // Score penalty at the border of the window, three sigmas from
                                     // the expected pose.

// A search on several targets uses a coarser step and fewer points: registration bridges the step.
constexpr double kCoarserOnSeveralTargets = 2.0;
constexpr int kFewerPointsOnSeveralTargets = 2;

/// Least half width of the searched window.
double min_window_m(const Place& source) {
  constexpr double kCells = 5.0;
  return kCells * search_cell_m(source);
}

double step_m(const Place& source, std::size_t targets) {
  return targets > 1 ? kCoarserOnSeveralTargets * search_cell_m(source) : search_cell_m(source);
}
int most_points(std::size_t targets) {
  return targets > 1 ? kMaxPoints / kFewerPointsOnSeveralTargets : kMaxPoints;
}

matching::WideSearchConfig search_config(const RevisitConfig& config, const Place& source,
                                         std::size_t targets) {
  return {.min_score = kMinScore,
          .border_cost = targets > 1 ? 0.0 : kBorderCost,
          .max_peaks = static_cast<std::size_t>(targets > 1 ? 2 * kMaxPeaks : kMaxPeaks),
          .min_peak_ratio = 0.8 * config.rival_ratio,
          .peak_separation_m = 5.0 * step_m(source, targets),
          .peak_separation_rad = 0.15};
}

Vector2 centroid_of(const std::vector<flow::Surfel>& surfels) {
  Vector2 sum = Vector2::Zero();
  for (const flow::Surfel& surfel : surfels) sum += Vector2(surfel.x_m, surfel.y_m);
  return sum / static_cast<double>(std::max<std::size_t>(surfels.size(), 1));
}

/// Evenly thinned surfels relative to their centroid, which decouples rotation from translation.
std::vector<Eigen::Vector2f> points_about(const Vector2& centre_m,
                                          const std::vector<flow::Surfel>& surfels,
                                          int max_points) {
  std::vector<Eigen::Vector2f> points;
  const std::size_t step = surfels.size() / static_cast<std::size_t>(max_points) + 1;
  for (std::size_t i = 0; i < surfels.size(); i += step) {
    points.emplace_back(surfels[i].x_m - static_cast<float>(centre_m.x()),
                        surfels[i].y_m - static_cast<float>(centre_m.y()));
  }
  return points;
}

bool has_unknown_heading(const UncertainPose2& expected) {
  return expected.covariance(2, 2) > kAnyHeadingSigma_rad * kAnyHeadingSigma_rad;
}

double sigma_m(const UncertainPose2& expected) {
  return std::sqrt(expected.covariance.topLeftCorner<2, 2>().trace());
}

/// `share`: of the half widths of the full window.
matching::SearchWindow window_around(const UncertainPose2& expected,
                                     const UncertainPose2& target_from_centre,
                                     const RevisitConfig& config, double least_m, double share) {
  const bool any_heading = has_unknown_heading(expected);
  const auto window = [&](double variance, double least, double most) {
    return std::max(share * std::clamp(kWindowSigmas * std::sqrt(variance), least, most), least);
  };
  const double most_m = any_heading ? config.astray_window_m : config.max_window_m;
  return {window(target_from_centre.covariance(0, 0), least_m, most_m),
          window(target_from_centre.covariance(1, 1), least_m, most_m),
          window(expected.covariance(2, 2), kMinWindow_rad,
                 any_heading ? std::numbers::pi : kMaxWindow_rad)};
}

}  // namespace

double search_cell_m(const Place& source) {
  constexpr double kMapCells = 2.0;  // A finer step costs its third power in time, a coarser one
                                     // misses narrow places.
  return kMapCells * source.cell_size_m;
}

RevisitSearch::RevisitSearch(const RevisitConfig& config, const Place& source,
                             std::vector<RevisitCandidate> candidates)
    : config_(config),
      source_(&source),
      candidates_(std::move(candidates)),
      source_from_centre_{centroid_of(source.surfels).x(), centroid_of(source.surfels).y(), 0.0},
      walls_(source.surfels),
      is_done_(candidates_.empty() || source.surfels.empty()) {
  if (is_done_) return;
  const bool starts_near =
      is_somewhere_expected() &&
      kNearShare * std::min(kWindowSigmas * searched_sigma_m(), config.max_window_m) >
          min_window_m(source);
  begin_search(starts_near ? kNearShare : 1.0);
}

void RevisitSearch::begin_search(double window_share) {
  window_share_ = window_share;
  targets_added_ = 0;
  peaks_judged_ = 0;
  search_.emplace(points_about(source_from_centre_.translation_m(), source_->surfels,
                               most_points(candidates_.size())),
                  step_m(*source_, candidates_.size()),
                  search_config(config_, *source_, candidates_.size()));
}

std::uint64_t RevisitSearch::advance(std::uint64_t most_work, PyramidCache& pyramids) {
  const std::uint64_t work_before = work_;
  const double window_share = window_share_;
  while (!is_done_ && window_share_ == window_share && work_ - work_before < most_work) {
    if (targets_added_ < candidates_.size()) {
      work_ += add_next_target(pyramids);
    } else if (!search_->is_done()) {
      work_ += search_->advance(most_work - (work_ - work_before));
    } else if (peaks_judged_ < search_->peaks().size()) {
      work_ += judge(search_->peaks()[peaks_judged_++]);
    } else if (!is_expectation_judged_) {
      is_expectation_judged_ = true;
      if (is_somewhere_expected())
        work_ += judge({.target = 0,
                        .target_from_source =
                            candidates_.front().target_from_source.pose * source_from_centre_});
    } else if (window_share_ < 1.0) {
      begin_search(1.0);
    } else {
      is_done_ = true;
    }
  }
  return work_ - work_before;
}

/// True if one pose is expected. It is then registered even where another pose along a corridor has
/// the greater score.
bool RevisitSearch::is_somewhere_expected() const {
  return candidates_.size() == 1 && !has_unknown_heading(candidates_.front().target_from_source);
}

double RevisitSearch::searched_sigma_m() const {
  return sigma_m(candidates_.front().target_from_source);
}

std::uint64_t RevisitSearch::add_next_target(PyramidCache& pyramids) {
  const RevisitCandidate& candidate = candidates_[targets_added_++];
  const auto [pyramid, work] =
      pyramids.pyramid_of(candidate.target, step_m(*source_, candidates_.size()));
  const UncertainPose2 target_from_centre =
      geometry::compound(candidate.target_from_source, {source_from_centre_, Matrix3::Zero()});
  return work +
         search_->add_target({pyramid, target_from_centre.pose,
                              window_around(candidate.target_from_source, target_from_centre,
                                            config_, min_window_m(*source_), window_share_),
                              candidate.map_from_target,
                              [headings = PlausibleHeadings(
                                   WallDirections(surfels_in_target(candidate.target)), walls_)](
                                  double heading_rad) { return headings.contains(heading_rad); }});
}

std::uint64_t RevisitSearch::judge(const matching::WidePeak& peak) {
  const auto& [target, expected, map_from_target] = candidates_[peak.target];
  const SurfelIndex index(surfels_in_target(target), coarse_gate_m(config_.registration));
  const Pose2 target_from_source = peak.target_from_source * geometry::inverse(source_from_centre_);
  const Registration registration =
      register_surfels(source_->surfels, index, target_from_source, config_.registration);
  const Hypothesis hypothesis{
      .from = target.members.front().place->id,
      .to = source_->id,
      .from_to = registration.target_from_source,
      .agreement = compare(target, *source_, registration.target_from_source.pose),
      .score = peak.score,
      .searched_sigma_m = sigma_m(expected)};
  const double least_agreed_share =
      has_unknown_heading(expected) ? kMinAgreedInSupport : config_.min_agreed_share;
  const bool holds = hypothesis.agreement.agreed_share() >= least_agreed_share &&
                     hypothesis.agreement.overlap_share() >= kMinOverlapShare;
  if (holds) hypotheses_.push_back(hypothesis);
  return kWorkOfRegisteringSurfel * source_->surfels.size() +
         kWorkOfComparingSurfel * index.surfels().size();
}

std::vector<Hypothesis> RevisitSearch::found() const {
  std::map<flow::SubmapId, std::vector<Hypothesis>> by_target;
  for (const Hypothesis& hypothesis : hypotheses_) by_target[hypothesis.from].push_back(hypothesis);
  std::vector<Hypothesis> all;
  for (auto& [id, hypotheses] : by_target) {
    select_on_one_target(hypotheses, config_.rival_ratio);
    all.insert(all.end(), hypotheses.begin(), hypotheses.end());
  }
  return all;
}

Agreement agreement_after_refining(const RevisitConfig& config, const Target& target,
                                   const Place& source, const Pose2& target_from_source) {
  const SurfelIndex index(surfels_in_target(target), coarse_gate_m(config.registration));
  const Registration registration =
      register_surfels(source.surfels, index, target_from_source, config.registration);
  return compare(target, source, registration.target_from_source.pose);
}

std::vector<Hypothesis> find_revisits(const RevisitConfig& config, const Target& target,
                                      const Place& source,
                                      const UncertainPose2& expected_target_from_source) {
  PyramidCache pyramids;
  RevisitSearch search(config, source, {{target, expected_target_from_source, Pose2::identity()}});
  while (!search.is_done()) search.advance(1'000'000, pyramids);
  return search.found();
}

}  // namespace slammot::loop_closing
