#include "services/localization/waiting_scans.hpp"

#include <utility>

namespace slammot::localization {
namespace {

constexpr int kOdometryPatience = 5;  ///< In turns.
/// The bus finds the writer of odometry in its own time, and after a crash nothing else bridges the
/// gap.
constexpr int kFirstOdometryPatience = 50;
/// The next scan of a live scanner ends the wait; a source that awaits its answer sends none.
constexpr int kTrackingPatience = 20;
/// Where scans queue up after a restart; otherwise these wait for nobody.
constexpr int kTrackingPatienceInQueue = 3;
constexpr int kHistoryPatience = 5;
/// After so many scans in a row that awaited something in vain, none awaits it any more.
constexpr int kVainWaits = 3;

}  // namespace

void WaitingScans::count_turn() {
  for (WaitingScan& waiting : scans_) ++waiting.turns;
}

void WaitingScans::note_objects(std::int64_t stamp_ns, bool awaits_labels) {
  newest_objects_.note(stamp_ns);
  if (!is_tracking_late(awaits_labels)) without_tracking_ = 0;
}

void WaitingScans::note_labels(std::int64_t stamp_ns, bool awaits_labels) {
  newest_labels_.note(stamp_ns);
  if (!is_tracking_late(awaits_labels)) without_tracking_ = 0;
}

bool WaitingScans::awaits_odometry(const Awaited& awaited) const {
  return !awaited.has_odometry && without_odometry_ < kVainWaits &&
         oldest().turns <= (awaited.is_first ? kFirstOdometryPatience : kOdometryPatience);
}

/// Labels and objects come on different topics; tracking publishes the objects first.
bool WaitingScans::is_tracking_late(bool awaits_labels) const {
  return awaits_labels || newest_objects_ < newest_labels_;
}

bool WaitingScans::awaits_tracking(const Awaited& awaited) const {
  const int patience_in_queue = awaited.is_back ? kTrackingPatienceInQueue : 0;
  const int patience = scans_.size() == 1 ? kTrackingPatience : patience_in_queue;
  return is_tracking_late(awaited.awaits_labels) && oldest().turns < patience &&
         without_tracking_ < kVainWaits;
}

bool WaitingScans::awaits_history(const Awaited& awaited) const {
  return awaited.awaits_history && oldest().turns < kHistoryPatience;
}

bool WaitingScans::may_begin(const Awaited& awaited) const {
  return !awaits_odometry(awaited) && !awaits_tracking(awaited) && !awaits_history(awaited);
}

WaitingScan WaitingScans::take(const Awaited& awaited) {
  WaitingScan oldest = std::move(scans_.front());
  scans_.pop_front();
  if (!awaited.has_odometry) ++without_odometry_;
  if (is_tracking_late(awaited.awaits_labels)) ++without_tracking_;
  return oldest;
}

}  // namespace slammot::localization
