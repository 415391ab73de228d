#include "services/localization/drive_gate.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace slammot::localization {
namespace {

constexpr std::size_t kMostCandidates = 8;
constexpr std::size_t kMostHeld = 200;  ///< Of one candidate.

}  // namespace

DriveGate::Verdict DriveGate::judge(WaitingScan scan, std::int64_t now_ns) {
  const std::string& scanner_id = scan.scan.scanner.scanner_id;
  Verdict verdict;
  if (watch_.look_at(scanner_id, scan.drive_id) == DriveWatch::Scan::kOfThisDrive) {
    watch_.judge(scanner_id, scan.drive_id);
    note_arrival(scanner_id, now_ns);
    verdict.admitted.push_back(std::move(scan));
  } else {
    hold(std::move(scan), verdict, now_ns);
  }
  return judge_held(std::move(verdict), now_ns);
}

DriveGate::Verdict DriveGate::judge_held(Verdict verdict, std::int64_t now_ns) {
  const auto beginning = std::ranges::find_if(
      candidates_, [&](const Candidate& candidate) { return begins(candidate, now_ns); });
  if (beginning != candidates_.end()) begin(Candidate(*beginning), verdict, now_ns);
  drop_old(verdict, now_ns);
  return verdict;
}

void DriveGate::note_arrival(const std::string& scanner_id, std::int64_t now_ns) {
  Pulse& pulse = pulses_[scanner_id];
  if (pulse.last_ns != 0) pulse.period.add(now_ns - pulse.last_ns);
  pulse.last_ns = now_ns;
}

void DriveGate::hold(WaitingScan scan, Verdict& verdict, std::int64_t now_ns) {
  const std::string& scanner_id = scan.scan.scanner.scanner_id;
  auto candidate = std::ranges::find_if(candidates_, [&](const Candidate& known) {
    return known.scanner_id == scanner_id && known.drive_id == scan.drive_id;
  });
  if (candidate == candidates_.end()) {
    // Many drives at once are nonsense: the one that has been silent longest makes room.
    if (candidates_.size() == kMostCandidates) {
      const auto oldest = std::ranges::min_element(candidates_, {}, &Candidate::last_ns);
      for (auto& held : oldest->held) verdict.strays.push_back(std::move(held.second));
      candidates_.erase(oldest);
    }
    candidates_.push_back({scanner_id, scan.drive_id, now_ns, now_ns, false, {}});
    candidate = std::prev(candidates_.end());
  }
  candidate->last_ns = now_ns;
  if (!candidate->held.empty() && candidate->held.back().second.scan.stamp_ns != scan.scan.stamp_ns)
    candidate->has_several_stamps = true;
  candidate->held.emplace_back(now_ns, std::move(scan));
  if (candidate->held.size() <= kMostHeld) return;
  verdict.strays.push_back(std::move(candidate->held.front().second));
  candidate->held.pop_front();
}

/// Of a scanner that has not named the drive at hand yet: of the one that was heard last.
DriveGate::Pulse DriveGate::pulse_of(const std::string& scanner_id) const {
  if (const auto own = pulses_.find(scanner_id);
      own != pulses_.end() && watch_.drives().contains(scanner_id))
    return own->second;
  Pulse newest;
  for (const auto& [other, pulse] : pulses_) {
    if (pulse.last_ns > newest.last_ns) newest = pulse;
  }
  return newest;
}

bool DriveGate::begins(const Candidate& candidate, std::int64_t now_ns) const {
  const Pulse pulse = pulse_of(candidate.scanner_id);
  if (candidate.last_ns < pulse.last_ns) return false;
  if (candidate.has_several_stamps)
    return now_ns - pulse.last_ns >= pulse.period.end_after_ns(kSilenceNs);
  return pulse.last_ns < candidate.first_ns &&
         now_ns - candidate.first_ns >= pulse.period.end_after_ns(kLoneScanNs);
}

/// One source sends several scanners: what is released later would be out of order.
bool DriveGate::comes_along(const Candidate& candidate, const Candidate& beginning) const {
  if (candidate.drive_id == beginning.drive_id) return true;
  return candidate.scanner_id != beginning.scanner_id && candidate.has_several_stamps &&
         candidate.first_ns > pulse_of(candidate.scanner_id).last_ns;
}

void DriveGate::begin(const Candidate& beginning, Verdict& verdict, std::int64_t now_ns) {
  const auto coming = std::stable_partition(  // clang 14 cannot compile that of std::ranges
      candidates_.begin(), candidates_.end(),
      [&](const Candidate& candidate) { return !comes_along(candidate, beginning); });
  std::vector<std::pair<std::int64_t, WaitingScan>> released;
  for (Candidate& candidate : std::span(coming, candidates_.end())) {
    watch_.readmit(candidate.drive_id);
    watch_.judge(candidate.scanner_id, candidate.drive_id);
    pulses_[candidate.scanner_id].last_ns = now_ns;
    std::ranges::move(candidate.held, std::back_inserter(released));
  }
  candidates_.erase(coming, candidates_.end());
  std::ranges::stable_sort(released, {}, [](const auto& held) { return held.first; });
  for (auto& held : released) verdict.admitted.push_back(std::move(held.second));
  verdict.begins_drive = true;
}

void DriveGate::drop_old(Verdict& verdict, std::int64_t now_ns) {
  constexpr std::int64_t kGraceNs = 300'000'000;
  for (Candidate& candidate : candidates_) {
    const std::int64_t longest_ns =
        pulse_of(candidate.scanner_id).period.end_after_ns(kLoneScanNs) + kGraceNs;
    while (!candidate.held.empty() && now_ns - candidate.held.front().first > longest_ns) {
      verdict.strays.push_back(std::move(candidate.held.front().second));
      candidate.held.pop_front();
    }
  }
  std::erase_if(candidates_, [](const Candidate& candidate) { return candidate.held.empty(); });
}

}  // namespace slammot::localization
