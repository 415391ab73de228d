#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/memory/recycling_queue.hpp"
#include "services/tracking/polar_view.hpp"

namespace slammot::tracking {

/// To which object an echo belonged when it was seen.
struct Owner {
  flow::TrackId track_id;
  bool is_owned = false;
  bool is_confirmed = false;
  bool has_come = false;     ///< The object is a vehicle that has proven to move, though it may have stood since, and its track have ended.
};

/// An earlier scan, with what tracking then knew of its echoes.
struct EarlierScan {
  std::int64_t stamp_ns = 0;
  PolarView view;
  std::vector<Owner> owners;  ///< One a beam.
};

/// What two scans say about the echo of a beam.
enum class Past : std::uint8_t {
  kUnknown,
  kStood,    ///< The earlier scan had an echo at the same place, from nothing that is known to move.
  kArrived,  ///< The earlier scan saw through this place.
  kAppeared, ///< The earlier scan had no echo in its direction, though it is near: most likely nothing was there.
  kReceded,  ///< Something nearer, not known to move, hid the place, and has gone.
};

/// Scans of the last seconds: comparing over a time in which slow motion shows (Wang 2004, Section 6.2) needs no map.
class ScanHistory {
 public:
  /// Whether enough time has passed since the scan kept last.
  bool is_due(std::int64_t stamp_ns) const;

  /// Keeps the scan if it is due.
  void add(std::int64_t stamp_ns, const PolarView& view, std::span<const Owner> owners);

  /// The youngest kept scan at least age_s older than the stamp; none where the history is shorter.
  const EarlierScan* older_than(std::int64_t stamp_ns, double age_s) const;

  /// What the echo of a beam says against an earlier scan, which must be one of those kept. It has appeared only if no scan
  /// kept up to that one had an echo near its place: what sends echoes now and then, being dark or thin, stands where it
  /// stood. Nor if one of the last moments, or since that one, had an echo as far away in the same direction: glass answers where
  /// it faces the scanner, and that place goes along with the vehicle. Without may_appear such an echo is kUnknown.
  Past past_of(std::size_t beam, const PolarView& now, const EarlierScan& then, bool may_appear) const;

  /// The same where it is known what the earlier scan says about the place of the echo.
  Past past_of(std::size_t beam, const SightOfPlace& before, const PolarView& now, const EarlierScan& then, bool may_appear) const;

  /// What has proven to move did so before, too: its echoes in the kept scans are those of something known to move.
  void confirm(flow::TrackId track_id);

  void clear() { scans_.clear(); }

 private:
  memory::RecyclingQueue<EarlierScan> scans_;
};

}  // namespace slammot::tracking
