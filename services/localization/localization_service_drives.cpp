// How LocalizationService begins, continues and ends drives.
#include <chrono>
#include <utility>

#include "common/app/log.hpp"
#include "services/localization/localization_service.hpp"
#include "services/localization/localization_service_clock.hpp"

namespace slammot::localization {
/// Where drives continue in the stored map, the first scan of a drive waits until that is known.
/// Older ones than a live sensor needs are dropped: a vehicle wants to know where it is now.
bool LocalizationService::knows_map_of(const WaitingScan& waiting) {
  constexpr std::size_t kMostWaiting = 100;
  if (!drive_.map_id && come_back(waiting)) return true;
  const bool is_new =
      !drive_.map_id || drives_.watch.look_at(waiting.scan.scanner.scanner_id, waiting.drive_id) ==
                            DriveWatch::Scan::kOfNewDrive;
  if (!drives_.stored_map || !is_new) return true;
  if (drive_.map_id) end_drive();
  else hand_over_earlier_drive();
  if (is_stored_map_known()) return true;
  while (waiting_.size() > kMostWaiting) {
    waiting_.drop_oldest();
    ++context_.status().counter("scans_before_map");
  }
  return false;
}

/// Reports in the status what is awaited, or what is wrong with the stored map.
bool LocalizationService::is_stored_map_known() {
  const StoredMapWatch::Answer answer = drives_.stored_map->answer(monotonic_ns());
  const bool waits = answer.verdict == StoredMapWatch::Verdict::kWait;
  context_.status().set_starting(waits);
  if (waits)
    context_.status().set_trouble("stored_map", "waits for the stored map: " + answer.reason);
  else if (answer.verdict == StoredMapWatch::Verdict::kCannot)
    context_.status().set_trouble("stored_map", "cannot go on in the stored map: " + answer.reason);
  else context_.status().clear_trouble("stored_map");
  return !waits;
}

void LocalizationService::admit(DriveGate::Verdict verdict) {
  for (WaitingScan& scan : verdict.admitted) {
    if (verdict.begins_drive) drives_.watch.readmit(scan.drive_id);
    waiting_.add(std::move(scan));
  }
  tell_of_strays(verdict.strays);
}

void LocalizationService::tell_of_strays(const std::vector<WaitingScan>& strays) {
  constexpr std::int64_t kToldForNs = 5'000'000'000;
  for (const WaitingScan& stray : strays) {
    const std::string& scanner_id = stray.scan.scanner.scanner_id;
    const std::string words = "dropped scans of drive " + std::to_string(stray.drive_id) +
                              " of scanner " + scanner_id + ": another drive goes on";
    context_.warn("stray_scans", words);
    context_.status().set_trouble("stray_scans", words);
    drives_.last_stray_ns = monotonic_ns();
  }
  if (!drives_.last_stray_ns || monotonic_ns() - *drives_.last_stray_ns < kToldForNs) return;
  drives_.last_stray_ns.reset();
  context_.status().clear_trouble("stray_scans");
}

/// Begins a drive where the scan is of a new one.
bool LocalizationService::is_of_this_drive(const WaitingScan& waiting) {
  const DriveWatch::Scan scan =
      drives_.watch.judge(waiting.scan.scanner.scanner_id, waiting.drive_id);
  if (scan == DriveWatch::Scan::kOfEarlierDrive) {
    context_.warn("scans_of_earlier_drives", "dropped a scan of an earlier drive");
    return false;
  }
  const bool is_new = !drive_.map_id || scan == DriveWatch::Scan::kOfNewDrive;
  if (is_new && !return_to_saved_drive(waiting)) begin_drive();
  return true;
}

/// Continues from the checkpoint, if it is of the drive of this scan.
bool LocalizationService::come_back(const WaitingScan& first) {
  auto saved = checkpoint_.look_back();
  if (!saved) return false;
  SavedSession& session = saved->session;
  const auto drive = session.drive_by_scanner.find(first.scan.scanner.scanner_id);
  if (drive == session.drive_by_scanner.end() || drive->second != first.drive_id) {
    app::log_info("the checkpoint is of another drive");
    drive_.before = std::move(session);
    return false;
  }
  if (!localizer_.restore(session.localizer)) {
    app::log_warn("begins a new map: the checkpoint is of another version or configuration");
    return false;
  }
  take_up(session);
  const double since_s = static_cast<double>(first.scan.stamp_ns - saved->stamp_ns) * 1e-9;
  if (since_s > 0.0) app::log_info("goes on from a checkpoint {:.1f} s before this scan", since_s);
  else app::log_info("goes on from a checkpoint with the scans since then");
  return true;
}

/// A stray drive may begin while the source of the right one is silent. The checkpoint is of the
/// right one until the other has saved its own.
bool LocalizationService::return_to_saved_drive(const WaitingScan& first) {
  if (!drive_.map_id) return false;  // come_back() has tried
  const auto saved = checkpoint_.read();
  if (!saved) return false;
  const auto drive = saved->session.drive_by_scanner.find(first.scan.scanner.scanner_id);
  if (drive == saved->session.drive_by_scanner.end() || drive->second != first.drive_id ||
      !localizer_.restore(saved->session.localizer))
    return false;
  take_up(saved->session);
  app::log_info("goes on with the drive of the checkpoint");
  return true;
}

void LocalizationService::take_up(const SavedSession& session) {
  drive_.is_back = !session.has_ended;
  drive_.map_id = session.map_id;
  drive_.odom_id = session.odom_id;
  drive_.first_submap = session.first_submap_id;
  drives_.watch.take_up(session.drive_by_scanner);
  drives_.gate.take_up(session.drive_by_scanner);
  scans_.take_up(session.last_answers);
  tell_whether_it_is_tied(drive_.first_submap.value == 0);
  if (const auto correction = corrections_.early.find(*drive_.map_id);
      correction != corrections_.early.end())
    correct(correction->second);
  context_.status().set_starting(false);
  context_.status().clear_trouble("stored_map");
  ++context_.status().counter("restored_checkpoints");
}

/// The vehicle was switched off in the middle of a submap of the stored map: the checkpoint holds
/// it, and it is the next one of that map.
void LocalizationService::hand_over_earlier_drive() {
  if (!drive_.before || !drives_.stored_map->map()) return;
  const SavedSession session = *std::exchange(drive_.before, std::nullopt);
  Localizer localizer(config_);
  if (session.map_id != drives_.stored_map->map()->map_id || !localizer.restore(session.localizer))
    return;
  localizer.finish();
  auto submap = localizer.take_finished_submap();
  if (!submap || submap->submap_id.value != drives_.stored_map->map()->last_submap_id.value + 1)
    return;
  submap->map_id = session.map_id;
  submaps_.publish(*submap);
  drives_.stored_map->is_on_its_way(session.map_id, submap->submap_id, monotonic_ns());
  app::log_info("hands over submap {}, with which the drive before ended", submap->submap_id.value);
}

/// The last submap is on its way into the map in which the next drive continues.
void LocalizationService::end_drive() {
  localizer_.finish();
  publish_finished_submaps();
  if (const auto newest = submaps_.newest())
    drives_.stored_map->is_on_its_way(*drive_.map_id, *newest, monotonic_ns());
}

void LocalizationService::begin_drive() {
  localizer_ = Localizer(config_);
  for (const sensing::Odometry& odometry : recent_odometry_.of_newest_drive())
    localizer_.add_odometry(odometry);
  scans_.clear();
  drive_.last_done_ns.reset();
  drive_.answers = {};
  drive_.is_back = false;
  checkpoint_.begin_drive();
  drive_.odom_id = new_id();
  const auto verdict = drives_.stored_map ? drives_.stored_map->answer(monotonic_ns()).verdict
                                          : StoredMapWatch::Verdict::kNothingStored;
  if (verdict == StoredMapWatch::Verdict::kGoOn) return go_on_in_stored_map();
  if (verdict == StoredMapWatch::Verdict::kCannot)
    ++context_.status().counter("begun_without_stored_map");
  begin_map();
}

/// Unlike any before, unless the clock was set back to the very nanosecond.
flow::OdomId LocalizationService::new_id() {
  if (drives_.ids.empty())
    return {
        static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count())};
  const flow::OdomId id{drives_.ids.front()};
  drives_.ids.pop_front();
  return id;
}

void LocalizationService::begin_map() {
  submaps_.withdraw();
  drive_.map_id = {drive_.odom_id.value};
  drive_.first_submap = {};
  tell_whether_it_is_tied(true);
  ++context_.status().counter("maps");
  app::log_info("begins map {}", drive_.map_id->value);
}

/// The graph is corrected as for the drive before, so that only later corrections are new.
void LocalizationService::go_on_in_stored_map() {
  const flow::StoredMap& stored = *drives_.stored_map->map();
  if (drive_.map_id != stored.map_id) submaps_.withdraw();
  drive_.map_id = stored.map_id;
  drive_.first_submap = {stored.last_submap_id.value + 1};
  localizer_.correct(drives_.stored_map->graph());
  localizer_.go_on_after(drives_.stored_map->graph().submaps.back());
  tell_whether_it_is_tied(false);
  ++context_.status().counter("continued_maps");
  app::log_info("goes on in map {} after its {} submaps", drive_.map_id->value, stored.submaps);
}

/// A correction without a submap of this drive is about the frame odom of an earlier drive.
void LocalizationService::correct(const flow::GraphCorrection& correction) {
  if (correction.submaps.empty() || correction.submaps.back().submap_id < drive_.first_submap)
    return;
  localizer_.correct(correction);
  tell_whether_it_is_tied(!correction.is_untied);
}

void LocalizationService::tell_whether_it_is_tied(bool is_tied) {
  if (is_tied) context_.status().clear_trouble("place");
  else
    context_.status().set_trouble("place", "not found in the map yet: poses in map mean nothing");
}

void LocalizationService::save_checkpoint(std::int64_t stamp_ns) {
  const std::int64_t now_ns = monotonic_ns();
  if (!checkpoint_.is_due(stamp_ns, now_ns)) return;
  if (checkpoint_.is_busy()) {
    ++context_.status().counter("scans_before_late_checkpoint");
    return;
  }
  const app::Stopwatch stopwatch(context_.status().latency("checkpoint"));
  const std::string fault = checkpoint_.fault();
  if (fault.empty()) {
    context_.status().clear_trouble("checkpoint");
  } else {
    context_.warn("failed_checkpoints", fault);
    context_.status().set_trouble("checkpoint", "no checkpoint: " + fault);
  }
  checkpoint_.save(stamp_ns, now_ns, session(), localizer_);
}

SavedSession LocalizationService::session() const {
  return {*drive_.map_id,
          drive_.odom_id,
          drive_.first_submap,
          drives_.watch.drives(),
          scans_.newest(),
          false,
          {}};
}

}  // namespace slammot::localization
