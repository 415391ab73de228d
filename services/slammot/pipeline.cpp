#include "services/slammot/pipeline.hpp"

#include <algorithm>
#include <utility>

#include "services/slammot/implementations.hpp"

namespace slammot {

Pipeline::Pipeline(const Profile& profile, int iterations)
    : detector_(profile.detection, &side_thread_),
      localizer_(localization_of(profile.implementations).make(profile, &side_thread_)),
      tracker_(tracking_of(profile.implementations).make(profile, &side_thread_)),
      loop_closer_(profile.loop_closing),
      iterations_(iterations) {}

/// Rebuilds the graph from the submaps, in the order in which they were made.
void Pipeline::continue_map(const std::vector<flow::Submap>& stored) {
  for (const flow::Submap& submap : stored) {
    const flow::GraphCorrection correction = loop_closer_.add(submap);
    record_.add(submap);
    record_.add(correction);
    if (!correction.submaps.empty()) localizer_->go_on_after(correction.submaps.back());
  }
}

void Pipeline::take(const sensing::Odometry& odometry) { localizer_->add_odometry(odometry); }

void Pipeline::take(const sensing::LaserScan& scan) {
  record_.add_scan(scan.stamp_ns);
  auto detected = localize_and_detect(scan);
  if (!detected) return;
  if (iterations_ > 1)
    detected = times_.measure("iteration", [&] { return iterate(scan, *std::move(detected)); });
  auto& [localized, segmented] = *detected;
  const stages::TrackingResult& tracked = times_.measure(
      "tracking", [&]() -> decltype(auto) { return tracker_->step(detected->segmented); });
  localizer_->expect(tracked.objects);
  times_.measure("mapping", [&] { localizer_->integrate(tracked.labels); });
  record_.add(localized);
  record_.add(segmented);
  record_.add(tracked.labels);
  record_.add(tracked.objects);
  traffic_.take(tracked.objects);
  recycled_localized_ = std::move(localized);
  recycled_segmented_ = std::move(segmented);
  close_loops();
}

std::optional<Pipeline::Detected> Pipeline::localize_and_detect(const sensing::LaserScan& scan) {
  auto localized = times_.measure(
      "localization", [&] { return localizer_->localize(scan, std::move(recycled_localized_)); });
  if (!localized) return std::nullopt;
  auto segmented = times_.measure(
      "detection", [&] { return detector_.detect(*localized, std::move(recycled_segmented_)); });
  return Detected{*std::move(localized), std::move(segmented)};
}

/// Matches the scan again without points labelled as moving by detection. Tracking is stateful and
/// processes the scan once, afterwards.
Pipeline::Detected Pipeline::iterate(const sensing::LaserScan& scan, Detected detected) {
  for (int iteration = 1; iteration < iterations_; ++iteration) {
    auto localized = localizer_->localize_again(scan, detected.segmented.labels);
    if (!localized) return detected;
    auto segmented = detector_.detect(*localized, std::move(detected.segmented));
    detected = {*std::move(localized), std::move(segmented)};
    if (iteration == 1) ++scans_iterated_;
    ++matches_again_;
  }
  return detected;
}

void Pipeline::finish() {
  localizer_->finish();
  close_loops();
  if (loop_closer_.has_unfinished_work()) {
    const auto correction = times_.measure("loop_closing", [&] { return loop_closer_.finish(); });
    localizer_->correct(correction);
    record_.add(correction);
  }
  for (const flow::Constraint& constraint : loop_closer_.constraints()) record_.add(constraint);
}

void Pipeline::close_loops() {
  while (auto submap = localizer_->take_finished_submap()) {
    const auto correction =
        times_.measure("loop_closing", [&] { return loop_closer_.add(*submap); });
    localizer_->correct(correction);
    record_.add(correction);
    traffic_.finish(*submap);
    record_.add(std::move(*submap));
  }
}

std::size_t Pipeline::accepted_closures() const {
  const auto closures = loop_closer_.constraints();
  return static_cast<std::size_t>(
      std::ranges::count_if(closures, [](const flow::Constraint& constraint) {
        return constraint.kind == flow::ConstraintKind::kLoop &&
               constraint.verdict.state == flow::ClosureState::kAccepted;
      }));
}

std::map<std::string, std::map<std::string, std::uint64_t>> Pipeline::counters() const {
  std::map<std::string, std::map<std::string, std::uint64_t>> counters{
      {"localization", localizer_->named_counters()},
      {"tracking", tracker_->named_counters()},
      {"loop_closing", named(loop_closer_.counters())}};
  if (iterations_ > 1)
    counters["iteration"] = {{"scans_iterated", scans_iterated_},
                             {"matches_again", matches_again_}};
  return counters;
}

}  // namespace slammot
