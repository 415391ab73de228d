#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/flow/arrival_period.hpp"
#include "services/localization/drive_watch.hpp"
#include "services/localization/waiting_scans.hpp"

namespace slammot::localization {

/// Decides whether scans that name another drive begin it, or are strays of another source. They
/// are held back until it is certain: a drive begins when its scanner no longer sends the drive
/// before. Then all scans held back of it are released, so that none is lost.
///
/// Times are of the arrival, by a clock that never goes back.
class DriveGate {
 public:
  /// A drive of which two scans have come begins when its scanner has not sent the drive before for
  /// this time, or for three of its scan periods if that is longer.
  static constexpr std::int64_t kSilenceNs = 500'000'000;
  /// A source that awaits an answer sends one scan only: its drive begins when the scanner has sent
  /// nothing else for this time.
  static constexpr std::int64_t kLoneScanNs = 900'000'000;

  struct Verdict {
    std::vector<WaitingScan> admitted;  ///< In the order of arrival.
    bool begins_drive = false;          ///< `admitted` are of another drive than those before.
    std::vector<WaitingScan> strays;    ///< Of drives that did not begin.
  };

  /// Judges a scan, and what is held back.
  Verdict judge(WaitingScan scan, std::int64_t now_ns);
  /// Judges what is held back. To be called several times in kSilenceNs.
  Verdict judge_held(std::int64_t now_ns) { return judge_held({}, now_ns); }

  /// Continues after the scans of an earlier process.
  void take_up(const std::map<std::string, std::uint64_t>& drives) { watch_.take_up(drives); }

  /// True if a drive waits for its beginning.
  bool holds() const { return !candidates_.empty(); }

 private:
  /// A drive as one scanner names it.
  struct Candidate {
    std::string scanner_id;
    std::uint64_t drive_id = 0;
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
    bool has_several_stamps = false;
    std::deque<std::pair<std::int64_t, WaitingScan>> held;  ///< With times of arrival.
  };
  /// Scans of a scanner that belong to the drive at hand.
  struct Pulse {
    std::int64_t last_ns = 0;
    flow::ArrivalPeriod period;
  };

  Verdict judge_held(Verdict verdict, std::int64_t now_ns);
  void note_arrival(const std::string& scanner_id, std::int64_t now_ns);
  void hold(WaitingScan scan, Verdict& verdict, std::int64_t now_ns);
  Pulse pulse_of(const std::string& scanner_id) const;
  bool begins(const Candidate& candidate, std::int64_t now_ns) const;
  bool comes_along(const Candidate& candidate, const Candidate& beginning) const;
  void begin(const Candidate& beginning, Verdict& verdict, std::int64_t now_ns);
  void drop_old(Verdict& verdict, std::int64_t now_ns);

  DriveWatch watch_;  ///< As of the last arrival.
  std::map<std::string, Pulse> pulses_;
  std::vector<Candidate> candidates_;
};

}  // namespace slammot::localization
