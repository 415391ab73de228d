#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/memory/recycling_queue.hpp"
#include "services/tracking/polar_view.hpp"

namespace slammot::tracking {

/// Ages of the earlier scans with which a scan is compared: for fast objects, most, and slow ones;
/// docs/decisions/moving-object-detection.md.
inline constexpr double kCompareFastAfterS = 0.25;
inline constexpr double kCompareAfterS = 0.8;
inline constexpr double kCompareSlowAfterS = 1.6;

/// The object to which an echo belonged when it was measured.
struct Owner {
  flow::TrackId track_id;
  bool is_owned = false;
  bool is_confirmed = false;
  bool has_come = false;  ///< The object is a vehicle that has moved; it may have stood since, and
                          ///< its track may have ended.
};

/// An earlier scan with the owners of its echoes.
struct EarlierScan {
  std::int64_t stamp_ns = 0;
  PolarView view;
  std::vector<Owner> owners;  ///< One for each beam.
};

/// What the comparison of two scans says of the echo of a beam.
enum class Past : std::uint8_t {
  kUnknown,
  kStood,     ///< The earlier scan had an echo at the same place, not of an object known to move.
  kArrived,   ///< The earlier scan saw through this place.
  kAppeared,  ///< The earlier scan had no echo in this direction, though the place is near: it was
              ///< probably empty.
  kReceded,   ///< A nearer surface, not known to move, hid the place and is gone.
};

/// Scans of the last seconds of one scanner. Comparison over a time in which slow motion shows
/// (Wang 2004, Section 6.2) needs no map.
class ScanHistory {
 public:
  /// True if enough time has passed since the last stored scan.
  bool is_due(std::int64_t stamp_ns) const;

  /// Stores the scan if it is due.
  void add(std::int64_t stamp_ns, const PolarView& view, std::span<const Owner> owners);

  /// The newest stored scan at least age_s older than the stamp; null where the history is shorter.
  const EarlierScan* older_than(std::int64_t stamp_ns, double age_s) const;

  /// What the echo of a beam says, compared with an earlier stored scan. An echo has appeared only
  /// if no stored scan up to that one had an echo near its place (dark or thin objects answer now
  /// and then), and none of the last moments, or since that one, had an echo at the same range and
  /// direction (glass answers where it faces the scanner, and that place moves with the vehicle).
  /// Without may_appear such an echo is kUnknown.
  Past past_of(std::size_t beam, const PolarView& now, const EarlierScan& then,
               bool may_appear) const;

  /// The same, given what the earlier scan shows at the place of the echo.
  Past past_of(std::size_t beam, const SightOfPlace& before, const PolarView& now,
               const EarlierScan& then, bool may_appear) const;

  /// Marks the echoes of this track in the stored scans as those of an object known to move.
  void confirm(flow::TrackId track_id);

  void clear() { scans_.clear(); }

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) { visit(self.scans_); }
  /// False for a state that no scans lead to.
  bool is_sound() const;
  /// Completes a sound state that was loaded.
  void measure_depths();

 private:
  memory::RecyclingQueue<EarlierScan> scans_;
};

}  // namespace slammot::tracking
