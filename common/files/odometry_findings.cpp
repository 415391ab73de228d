#include "common/files/odometry_findings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/files/text.hpp"

namespace slammot::files {
namespace {

using sensing::OdometryConclusions;
using sensing::OdometryEpisode;
using sensing::OdometryFault;

constexpr std::size_t kMostEpisodesTold = 3;
constexpr double kLeastError = 0.01;  // of way and turn; smaller errors are not reported
constexpr double kLeastBias_radps = 0.002;
constexpr double kLeastOffset_s = 0.01;
constexpr double kMostDisbelievedShare = 0.5;
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string line;
  for (const std::string& part : parts) line += (line.empty() ? "" : between) + part;
  return line;
}

double seconds_into(const OdometryConclusions& odometry, std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns - odometry.first_stamp_ns) * 1e-9;
}

/// Ratio of odometry to truth as text; empty if close to 1.
std::string describe_factor(const char* what, double true_by_said, const char* more,
                            const char* less) {
  if (true_by_said < 0.0) return text("%s with the wrong sign", what);
  const double error = 1.0 / std::max(true_by_said, 1e-6) - 1.0;
  if (std::abs(error) < kLeastError) return {};
  if (error > 1.0) return text("%s %.3g times too %s", what, 1.0 + error, more);
  return text("%s %.0f %% %s", what, 100.0 * std::abs(error), error > 0.0 ? more : less);
}

std::vector<std::string> describe_factors(const OdometryConclusions& odometry) {
  std::vector<std::string> parts{describe_factor("way", odometry.total.way, "long", "short"),
                                 describe_factor("turn rate", odometry.total.turn, "high", "low")};
  if (std::abs(odometry.total.turn_bias_radps) > kLeastBias_radps)
    parts.push_back(text("turns by %.2g deg/s of its own",
                         -kDegreesPerRadian * odometry.total.turn_bias_radps));
  if (std::abs(odometry.stamp_offset_s) > kLeastOffset_s)
    parts.push_back(text("%.2f s %s", std::abs(odometry.stamp_offset_s),
                         odometry.stamp_offset_s > 0.0 ? "late" : "early"));
  std::erase(parts, std::string());
  return parts;
}

std::string describe_trust(const OdometryConclusions& odometry, bool time_is_known) {
  const double disbelieved =
      static_cast<double>(odometry.disbelieved) / static_cast<double>(odometry.with_odometry);
  if (disbelieved > kMostDisbelievedShare)
    return text("not believed in %.0f %% of the steps", 100.0 * disbelieved);
  if (odometry.recalibrations.empty()) return "believed";
  const sensing::OdometryRecalibration& last = odometry.recalibrations.back();
  return time_is_known
             ? text("corrected since %.0f s", seconds_into(odometry, last.stamp_ns))
             : text("corrected since scan %llu", static_cast<unsigned long long>(last.scan));
}

const char* verb_of(OdometryFault fault) {
  switch (fault) {
    case OdometryFault::kMissing: return "missing";
    case OdometryFault::kJumped: return "jumped";
    case OdometryFault::kFrozen: return "frozen";
    case OdometryFault::kMovedAlone: return "moved while the vehicle stood";
    case OdometryFault::kWrongDirection: return "went the wrong way";
    case OdometryFault::kWrongTurn: return "turned the wrong way";
    case OdometryFault::kSlipped: return "slipped";
    case OdometryFault::kShort: return "counted too little";
    case OdometryFault::kMisturned: return "turned too much or too little";
    case OdometryFault::kRough: return "rough";
  }
  return "";
}

std::string describe_episode(const OdometryEpisode& episode, const OdometryConclusions& odometry,
                             bool time_is_known) {
  std::string what = verb_of(episode.fault);
  if (episode.fault == OdometryFault::kJumped)
    what += text(" by %.2g m", std::abs(episode.way_by_wheels_m - episode.way_by_matches_m));
  else if (time_is_known)
    what += text(" for %.*f s", episode.duration_s() < 2.0 ? 1 : 0, episode.duration_s());
  else what += text(" for %llu scans", static_cast<unsigned long long>(episode.scans));
  if (time_is_known) return what + text(" at %.0f s", seconds_into(odometry, episode.begin_ns));
  return what + text(" at scan %llu", static_cast<unsigned long long>(episode.first_scan));
}

/// The longest episodes in order of the drive, and the number of the others.
std::vector<std::string> describe_episodes(const OdometryConclusions& odometry,
                                           bool time_is_known) {
  std::vector<const OdometryEpisode*> told;
  for (const OdometryEpisode& episode : odometry.episodes) told.push_back(&episode);
  std::stable_sort(told.begin(), told.end(),
                   [](const auto* a, const auto* b) { return a->scans > b->scans; });
  const std::uint64_t more =
      odometry.more_episodes +
      (told.size() > kMostEpisodesTold ? told.size() - kMostEpisodesTold : 0);
  told.resize(std::min(told.size(), kMostEpisodesTold));
  std::sort(told.begin(), told.end(),
            [](const auto* a, const auto* b) { return a->begin_ns < b->begin_ns; });
  std::vector<std::string> lines;
  for (const OdometryEpisode* episode : told)
    lines.push_back(describe_episode(*episode, odometry, time_is_known));
  if (more > 0)
    lines.push_back(text("%llu more times not believed", static_cast<unsigned long long>(more)));
  return lines;
}

/// Why the turns of a gyro are not used.
std::string doubt_of_gyro(const sensing::GyroUse& gyro) {
  if (gyro.turn_ratio == 0.0)
    return "the wheels have hardly turned yet: nothing to compare it with";
  if (gyro.turn_ratio < 0.0) return "it turns against the wheels: sign, or mounted upside down";
  if (!gyro.bias_is_known) return "its bias is not known: it needs straights or stops";
  return text("it turns %.2f times as much as the wheels: unit, or mounted otherwise",
              gyro.turn_ratio);
}

}  // namespace

const char* name_of(OdometryFault fault) {
  switch (fault) {
    case OdometryFault::kMissing: return "missing";
    case OdometryFault::kJumped: return "jumped";
    case OdometryFault::kFrozen: return "frozen";
    case OdometryFault::kMovedAlone: return "moved_while_standing";
    case OdometryFault::kWrongDirection: return "wrong_direction";
    case OdometryFault::kWrongTurn: return "wrong_turn";
    case OdometryFault::kSlipped: return "slipped";
    case OdometryFault::kShort: return "short";
    case OdometryFault::kMisturned: return "misturned";
    case OdometryFault::kRough: return "rough";
  }
  return "";
}

std::string describe_odometry(const OdometryConclusions& odometry, bool time_is_known) {
  if (odometry.with_odometry == 0) return "none";
  std::vector<std::string> facts = describe_factors(odometry);
  facts.push_back(describe_trust(odometry, time_is_known));
  std::vector<std::string> parts{joined(facts, ", ")};
  for (const std::string& episode : describe_episodes(odometry, time_is_known))
    parts.push_back(episode);
  return joined(parts, "; ");
}

std::string describe_gyro(const sensing::GyroUse& gyro) {
  if (gyro.used_s == 0.0) return "not used: " + doubt_of_gyro(gyro);
  return text(
      "its turns replace those of the wheels for %.0f of %.0f s; bias %.3f degrees a second",
      gyro.used_s, gyro.read_s, kDegreesPerRadian * gyro.bias_radps);
}

}  // namespace slammot::files
