#include "services/tracking/tracking_service.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include "common/app/log.hpp"
#include "common/wire/segmented_scan.hpp"
#include "services/tracking/tracking_fields.hpp"

namespace slammot::tracking {
namespace {

using namespace std::chrono_literals;

/// How long the first scans wait for tracks that map_store keeps, where there is no journal.
constexpr auto kStoredTracksPatience = 1s;
constexpr std::size_t kMostEarlyScans = 100;
/// Tracks older than this, by the data's clock, are of objects that are elsewhere by now.
constexpr std::int64_t kLongestAbsenceNs = 5'000'000'000;
/// Of the journal, by the data's clock: a track is predicted over it without harm.
constexpr std::int64_t kSavePeriodNs = 250'000'000;
/// More than are begun in a save period and while a state is written.
constexpr std::uint32_t kIdsOfUnsavedScans = 1000;
/// As many as detection keeps for a restart.
const std::int64_t kMostRepeated = dds::qos_profile(dds::topics::kSegmentedScan.flow).restart_depth;

/// What the positions of objects are said in.
template <typename Sample>
DriveFrame frame_of(const Sample& sample) {
  return {sample.map_id, sample.odom_id};
}

/// A scan that is sent again may be a little older.
bool is_near(std::int64_t stamp_ns, std::int64_t saved_ns) {
  return std::abs(stamp_ns - saved_ns) <= kLongestAbsenceNs;
}

std::filesystem::path journal_path(const app::ServiceOptions& options) {
  return app::state_path(options, "tracking", app::StateOf::kVehicle, ".journal");
}

}  // namespace

std::vector<config::BoundStage> TrackingService::stages(Settings& settings) {
  return {config::bind_stage("tracking", tracking_fields(), settings.config)};
}

TrackingService::TrackingService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      tracker_(settings.config),
      objects_(context.write(dds::topics::kTrackedObjects)),
      labels_(context.write(dds::topics::kScanLabels)),
      journal_{app::StateFile(journal_path(context.options())), std::nullopt, false} {
  take_up_journal();
  context.read(dds::topics::kStoredTrackedObjects, app::Input::kOccasional,
               [this](const auto& sample) { take_stored(sample); });
  context.read(
      dds::topics::kSegmentedScan, app::Input::kSteady,
      [this](const auto& sample) { take(sample); }, dds::History::kRestart);
  context.status().set_starting(handover_.is_awaited);  // a source of scans waits for it
  context.after(kStoredTracksPatience, [this] { begin(); });
  context.after(app::RepeatWatch::kBegins, [this] { answer_what_is_owed(); });
  context.before_report([this] { context_.status().set_counters(named(tracker_.counters())); });
}

void TrackingService::prepare(app::ServiceContext& context) {
  context.prepare(dds::topics::kSegmentedScan, dds::History::kRestart);
  context.prepare_to_write(dds::topics::kTrackedObjects);
  context.prepare_to_write(dds::topics::kScanLabels);
}

bool TrackingService::is_newest(const flow::TrackedObjects& stored) const {
  return !stored.objects.empty() &&
         (!handover_.tracks || stored.stamp_ns > handover_.tracks->stamp_ns);
}

/// Of several that were kept the newest counts; once tracking goes on they are echoes of its own.
void TrackingService::take_stored(const slammot_TrackedObjects& sample) {
  if (!handover_.is_awaited) return;
  auto objects = wire::decode(sample);
  if (!objects)
    return context_.warn("faulty_tracks", "dropped stored tracks: " + std::string(objects.fault()));
  if (is_newest(*objects)) handover_.tracks = std::move(*objects);
  context_.after(0s, [this] { begin(); });  // after all that were kept have been taken
}

void TrackingService::take(const slammot_SegmentedScan& sample) {
  auto scan = wire::decode(sample);
  if (!scan)
    return context_.warn("faulty_segmented_scan",
                         "dropped a segmented scan: " + std::string(scan.fault()));
  ScanOnTheBus on_the_bus{std::move(*scan), sample.scan_published_ns};
  if (!handover_.is_awaited) return track(on_the_bus);
  handover_.early_scans.push_back(std::move(on_the_bus));
  if (handover_.early_scans.size() > kMostEarlyScans) handover_.early_scans.pop_front();
}

void TrackingService::begin() {
  if (!handover_.is_awaited) return;
  handover_.is_awaited = false;
  context_.status().set_starting(false);
  for (const ScanOnTheBus& scan : handover_.early_scans) track(scan);
  handover_.early_scans.clear();
}

/// Of the process before. Whether the drive goes on is seen at the first scan.
void TrackingService::take_up_journal() {
  const auto saved = journal_.file.read();
  if (!saved) return;
  session_ = restore(saved->bytes, tracker_);
  if (!session_) return app::log_warn("the journal is of another version: it is not used");
  journal_.saved_ns = saved->stamp_ns;
  journal_.is_unproven = true;
  handover_.is_awaited = false;
}

/// True if no scan is missing between the saved state and this one: tracks that were begun
/// meanwhile begin again with the same ids.
bool TrackingService::follows_journal(const flow::SegmentedScan& first) const {
  const auto last = session_->last_results.find(first.scanner_id);
  if (last == session_->last_results.end()) return false;
  const std::int64_t missed = static_cast<std::int64_t>(first.sequence) -
                              static_cast<std::int64_t>(last->second.labels.sequence) - 1;
  return missed <= 0 && missed >= -kMostRepeated;
}

/// Scans that are missing between the last saved state and this one may have begun tracks.
void TrackingService::prove_journal(const flow::SegmentedScan& first) {
  journal_.is_unproven = false;
  if (frame_of(first) != session_->frame) return begin_drive(first);
  const bool is_whole = follows_journal(first);
  const std::uint32_t next_id = tracker_.next_id() + (is_whole ? 0 : kIdsOfUnsavedScans);
  const bool goes_on = is_whole || is_near(first.stamp_ns, *journal_.saved_ns);
  if (!goes_on) begin_drive(first);
  tracker_.begin_ids_at(next_id);
  if (!goes_on) return;
  ++context_.status().counter("taken_up");
  if (is_whole) return app::log_info("goes on from a journal with the scans since then");
  app::log_info("goes on from a journal {:.2f} s before this scan",
                static_cast<double>(first.stamp_ns - *journal_.saved_ns) * 1e-9);
}

/// Nothing of another drive is known here, if its numbers, its stamps and its map are the same or
/// not.
void TrackingService::begin_drive(const flow::SegmentedScan& first) {
  tracker_ = Tracker(config_);
  session_ = Session{frame_of(first), {}};
  journal_.saved_ns.reset();
  if (handover_.tracks && frame_of(*handover_.tracks) == session_->frame)
    take_up(*handover_.tracks, first.stamp_ns);
  handover_.tracks.reset();
}

void TrackingService::take_up(const flow::TrackedObjects& stored, std::int64_t first_stamp_ns) {
  if (!is_near(first_stamp_ns, stored.stamp_ns)) return;
  tracker_.resume(stored);
  ++context_.status().counter("taken_up");
  app::log_info("takes up {} stored tracks", stored.objects.size());
}

void TrackingService::track(const ScanOnTheBus& on_the_bus) {
  const flow::SegmentedScan& scan = on_the_bus.scan;
  if (journal_.is_unproven) prove_journal(scan);
  if (!session_ || session_->frame != frame_of(scan)) begin_drive(scan);
  const auto last = session_->last_results.find(scan.scanner_id);
  if (last != session_->last_results.end() && scan.stamp_ns <= last->second.labels.stamp_ns)
    return answer_again(on_the_bus, last->second);
  {
    const app::Stopwatch stopwatch(context_.status().latency("track"));
    TrackingResult& result = session_->last_results[scan.scanner_id];
    result = tracker_.step(scan);
    publish(result, on_the_bus.published_ns);
  }
  context_.note_since_scan("scan_to_tracks", on_the_bus.published_ns);
  save_if_due(scan.stamp_ns);
}

/// To a scan that is sent again because somebody missed the answer.
void TrackingService::answer_again(const ScanOnTheBus& repeated, const TrackingResult& last) {
  const auto& [scan, published_ns] = repeated;
  ++context_.status().counter("repeated_scans");
  if (repeats_.asks_for_answer(scan.scanner_id, scan.stamp_ns, last.labels.stamp_ns))
    publish(last, published_ns);
}

void TrackingService::answer_what_is_owed() {
  for (const std::string& scanner_id : repeats_.take_owed()) {
    if (!session_) return;
    const auto last = session_->last_results.find(scanner_id);
    if (last != session_->last_results.end()) publish(last->second, 0);
  }
}

/// After the answer to the scan, so that nobody waits for it.
void TrackingService::save_if_due(std::int64_t stamp_ns) {
  const bool is_due = !journal_.saved_ns || stamp_ns - *journal_.saved_ns >= kSavePeriodNs;
  if (!is_due || journal_.file.is_busy()) return;
  const app::Stopwatch stopwatch(context_.status().latency("journal"));
  const std::string fault = journal_.file.fault();
  if (fault.empty()) {
    context_.status().clear_trouble("journal");
  } else {
    context_.warn("failed_journals", fault);
    context_.status().set_trouble("journal", "no journal: " + fault);
  }
  save(stamp_ns);
}

void TrackingService::save(std::int64_t stamp_ns) {
  journal_.file.save({stamp_ns, to_bytes(*session_, tracker_)});
  journal_.saved_ns = stamp_ns;
}

TrackingService::~TrackingService() {
  if (session_ && !journal_.is_unproven && tracker_.last_stamp_ns() != journal_.saved_ns)
    save(tracker_.last_stamp_ns());
}

/// Objects first: localization must know them when the labels let the next scan come.
void TrackingService::publish(const TrackingResult& result, std::int64_t scan_published_ns) {
  objects_.write(objects_encoder_.encode(context_.vehicle_id(), result.objects, scan_published_ns));
  labels_.write(labels_encoder_.encode(context_.vehicle_id(), result.labels, scan_published_ns));
}

}  // namespace slammot::tracking
