#include "services/slammot/warn_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "common/files/decimal.hpp"
#include "common/files/failure.hpp"
#include "services/collision_warning/collision_monitor.hpp"
#include "services/evaluator/result_files.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/profile.hpp"

namespace slammot {
namespace {

using geometry::Pose2;

constexpr const char* kOutput = "collision_warnings.csv";
/// Less likely contacts are not written.
constexpr double kLeastWrittenProbability = 0.01;

struct WarnOptions {
  std::filesystem::path result;
  std::filesystem::path config;  ///< Empty: the settings of the run, if they are in its folder.
};

/// Pose as published live at this very stamp; null if there is none.
const metrics::StampedPose* pose_at(const metrics::Trajectory& online, std::int64_t stamp_ns) {
  const auto at = std::ranges::lower_bound(online, stamp_ns, {}, &metrics::StampedPose::stamp_ns);
  return at != online.end() && at->stamp_ns == stamp_ns ? &*at : nullptr;
}

flow::TrackedObject object_of(const evaluator::ResultTrack& track, const Pose2& odom_from_map) {
  const geometry::Matrix2 turn = geometry::rotation(odom_from_map.heading_rad);
  const Pose2 odom_from_object = odom_from_map * track.map_from_object;
  flow::TrackedObject object;
  object.track_id = {track.track_id};
  object.confirmed = true;
  object.occluded = track.is_occluded;
  object.existence = 1.0;
  object.position_in_odom_m = odom_from_object.translation_m();
  object.velocity_in_odom_mps = turn * track.velocity_in_map_mps;
  if (track.position_covariance_m2)
    object.covariance.topLeftCorner<2, 2>() =
        turn * *track.position_covariance_m2 * turn.transpose();
  if (track.velocity_covariance_m2ps2)
    object.covariance.bottomRightCorner<2, 2>() =
        turn * *track.velocity_covariance_m2ps2 * turn.transpose();
  object.heading_in_odom_rad = odom_from_object.heading_rad;
  object.length_m = track.length_m;
  object.width_m = track.width_m;
  object.object_class = track.object_class == "pedestrian" ? flow::ObjectClass::kPedestrian
                                                           : flow::ObjectClass::kUnknown;
  object.motion = track.is_moving ? flow::Motion::kMoving : flow::Motion::kStopped;
  return object;
}

/// The tracks as published live, scan by scan: online.tum and online_covariance.csv give
/// map_from_odom.
class TracksOfResult {
 public:
  explicit TracksOfResult(const evaluator::RunResult& result)
      : result_(result), next_(result.tracks.begin()) {}

  /// None where the scan has no pose in map. Call with ascending stamps.
  std::optional<flow::TrackedObjects> at(const metrics::UncertainStampedPose& localized) {
    const metrics::StampedPose* online = pose_at(result_.online, localized.stamp_ns);
    if (online == nullptr) return std::nullopt;
    flow::TrackedObjects tracked;
    tracked.stamp_ns = localized.stamp_ns;
    tracked.odom_from_base = localized.odom_from_base.pose;
    tracked.map_from_odom = online->pose * inverse(tracked.odom_from_base);
    while (next_ != result_.tracks.end() && next_->stamp_ns < localized.stamp_ns) ++next_;
    if (next_ == result_.tracks.end() || next_->stamp_ns != localized.stamp_ns) return tracked;
    const Pose2 odom_from_map = inverse(tracked.map_from_odom);
    for (const evaluator::ResultTrack& track : next_->tracks)
      tracked.objects.push_back(object_of(track, odom_from_map));
    return tracked;
  }

 private:
  const evaluator::RunResult& result_;
  std::vector<evaluator::TracksAt>::const_iterator next_;
};

std::string_view name_of(flow::WarningLevel level) {
  if (level == flow::WarningLevel::kWarning) return "warning";
  return level == flow::WarningLevel::kCaution ? "caution" : "none";
}

void append_rows(const flow::CollisionWarnings& warnings, std::string& text) {
  for (const flow::CollisionWarning& object : warnings.objects) {
    if (object.level == flow::WarningLevel::kNone && object.probability < kLeastWrittenProbability)
      continue;
    files::append_stamp(text, warnings.stamp_ns);
    text.append(",").append(std::to_string(object.track_id.value));
    text.append(",").append(name_of(object.level));
    for (const double value : {object.probability, object.time_to_collision_s,
                               object.closest_distance_m, object.time_to_closest_s})
      files::append_fixed(text.append(","), value, 3);
    text.append("\n");
  }
}

/// Settings that the run was made with, or those given.
std::optional<std::string> load(const WarnOptions& options, Profile& profile) {
  const std::filesystem::path of_run = options.result / kSettingsFile;
  if (std::filesystem::exists(of_run)) {
    if (auto fault = load_settings("", of_run, profile)) return fault;
  }
  return load_settings("", options.config, profile);
}

int warn(const WarnOptions& options) {
  Profile profile;
  if (const auto fault = load(options, profile)) return files::fail(*fault);
  const auto result = evaluator::read_result(options.result);
  if (!result) return files::fail(result.error().message);
  if (result->uncertain.empty())
    return files::fail((options.result / "online_covariance.csv").string() + ": no poses");
  collision_warning::CollisionMonitor monitor(profile.collision_warning);
  TracksOfResult tracks(*result);
  std::string text =
      "timestamp,track_id,level,probability,time_to_collision,closest_distance,time_to_closest\n";
  int warnings = 0;
  auto last_level = flow::WarningLevel::kNone;
  for (const metrics::UncertainStampedPose& localized : result->uncertain) {
    const auto tracked = tracks.at(localized);
    if (!tracked) continue;
    const flow::CollisionWarnings step = monitor.step(*tracked);
    append_rows(step, text);
    const bool begins = step.highest_level == flow::WarningLevel::kWarning &&
                        last_level != flow::WarningLevel::kWarning;
    warnings += begins ? 1 : 0;
    last_level = step.highest_level;
  }
  const std::filesystem::path output = options.result / kOutput;
  if (const auto fault = files::write_file_atomically(output, text))
    return files::fail(fault->message);
  std::printf("%d warnings; all encounters are in %s\n", warnings, output.c_str());
  return kExitDone;
}

}  // namespace

void add_warn_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "warn", "Predict collisions from the outputs of a run; writes collision_warnings.csv");
  const auto options = std::make_shared<WarnOptions>();
  command->add_option("--result", options->result, "Folder of the run's outputs")
      ->required()
      ->type_name("DIR");
  command->add_option("--config", options->config, "Settings that override those of the run")
      ->type_name("FILE");
  command->callback([options, &exit_code] { exit_code = warn(*options); });
}

}  // namespace slammot
