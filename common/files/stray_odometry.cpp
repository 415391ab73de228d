#include "common/files/stray_odometry.hpp"

#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "common/sensing/stray_poses.hpp"

namespace slammot::files {
namespace {

/// Pose of a record, headings in radians.
struct PlacedPose {
  geometry::Pose2 wheel_from_base;
  std::optional<std::int64_t> ipc_ns;
  std::optional<std::int64_t> logger_ns;
  bool is_of_scan = false;
  std::size_t number = 0;  ///< Among the records of its kind.
};

double heading_unit_rad(const RecordedPoses& poses) {
  return poses.check.is_in_degrees() ? std::numbers::pi / 180.0 : 1.0;
}

PlacedPose placed(const RecordedPoses& poses, const RecordedStamps& stamps, bool is_of_scan,
                  std::size_t number) {
  geometry::Pose2 pose = poses.all[number];
  pose.heading_rad *= heading_unit_rad(poses);
  return {pose, stamps.ipc_ns[number], stamps.logger_ns[number], is_of_scan, number};
}

std::vector<PlacedPose> sequence_of(const RecordedPoses& poses, const RecordedStamps& stamps,
                                    bool is_of_scan) {
  std::vector<PlacedPose> sequence;
  for (std::size_t i = 0; poses.change && i < poses.all.size(); ++i)
    sequence.push_back(placed(poses, stamps, is_of_scan, i));
  return sequence;
}

/// Scans and the lines before each.
std::vector<PlacedPose> sequence_of(const ScannerSurvey& scanner, const OdometryLines& lines,
                                    const LinesBetween& between) {
  std::vector<PlacedPose> sequence;
  const bool agree = scanner.agreement.agrees() || scanner.agreement_by_order.agrees();
  if (!agree || !scanner.poses.change || !lines.poses.change) return sequence;
  std::size_t line = 0;
  for (std::size_t scan = 0; scan < scanner.poses.all.size(); ++scan) {
    for (std::size_t end = line + between.before_scan[scan]; line < end; ++line)
      sequence.push_back(placed(lines.poses, lines.stamps, false, line));
    sequence.push_back(placed(scanner.poses, scanner.stamps, true, scan));
  }
  for (; line < lines.count(); ++line)
    sequence.push_back(placed(lines.poses, lines.stamps, false, line));
  return sequence;
}

/// How far a stamp lies between two others, (0, 1); nullopt unless they are in this order.
std::optional<double> share_between(const std::optional<std::int64_t>& before_ns,
                                    const std::optional<std::int64_t>& stamp_ns,
                                    const std::optional<std::int64_t>& after_ns) {
  if (!before_ns || !stamp_ns || !after_ns) return std::nullopt;
  if (*stamp_ns <= *before_ns || *stamp_ns >= *after_ns) return std::nullopt;
  return static_cast<double>(*stamp_ns - *before_ns) / static_cast<double>(*after_ns - *before_ns);
}

/// By the stamps; where they are no clock by the order.
geometry::Pose2 pose_between(const std::vector<PlacedPose>& sequence,
                             const sensing::StrayPose& stray) {
  const PlacedPose& before = sequence[stray.before];
  const PlacedPose& after = sequence[stray.after];
  const PlacedPose& wrong = sequence[stray.place];
  auto share = share_between(before.ipc_ns, wrong.ipc_ns, after.ipc_ns);
  if (!share) share = share_between(before.logger_ns, wrong.logger_ns, after.logger_ns);
  const double by_order = static_cast<double>(stray.place - stray.before) /
                          static_cast<double>(stray.after - stray.before);
  return geometry::interpolate(before.wheel_from_base, after.wheel_from_base,
                               share.value_or(by_order));
}

std::vector<sensing::StrayPose> stray_poses_of(const std::vector<PlacedPose>& sequence) {
  std::vector<geometry::Pose2> poses;
  poses.reserve(sequence.size());
  for (const PlacedPose& place : sequence) poses.push_back(place.wheel_from_base);
  return sensing::stray_poses(poses);
}

/// Adds those of a sequence of scans, lines or both; what is known already stays.
void add_stray(const std::vector<PlacedPose>& sequence, double heading_unit_rad,
               std::map<std::size_t, geometry::Pose2>* scans, std::set<std::size_t>* lines) {
  for (const sensing::StrayPose& stray : stray_poses_of(sequence)) {
    const PlacedPose& wrong = sequence[stray.place];
    if (!wrong.is_of_scan) {
      lines->insert(wrong.number);
      continue;
    }
    geometry::Pose2 instead = pose_between(sequence, stray);
    instead.heading_rad /= heading_unit_rad;
    scans->emplace(wrong.number, instead);
  }
}

}  // namespace

std::size_t StrayOdometry::count() const {
  std::size_t count = lines[0].size() + lines[1].size();
  for (const auto& [scanner, poses] : scans) count += poses.size();
  return count;
}

StrayOdometry stray_odometry_of(const std::deque<ScannerSurvey>& scanners,
                                const OdometryLinesByKind& lines) {
  StrayOdometry stray;
  for (const ScannerSurvey& scanner : scanners) {
    auto& of_scanner = stray.scans[{scanner.kind, scanner.slot}];
    const double unit_rad = heading_unit_rad(scanner.poses);
    for (std::size_t kind = 0; kind < lines.size(); ++kind)
      add_stray(sequence_of(scanner, lines[kind], scanner.lines_between[kind]), unit_rad,
                &of_scanner, &stray.lines[kind]);
    add_stray(sequence_of(scanner.poses, scanner.stamps, true), unit_rad, &of_scanner, nullptr);
  }
  for (std::size_t kind = 0; kind < lines.size(); ++kind)
    add_stray(sequence_of(lines[kind].poses, lines[kind].stamps, false), 1.0, nullptr,
              &stray.lines[kind]);
  return stray;
}

std::optional<CarmenRecord> WithoutStrayOdometry::next() {
  while (auto record = records().next()) {
    if (auto* laser = std::get_if<LaserRecord>(&*record)) mend(*laser);
    const auto* odometry = std::get_if<OdometryRecord>(&*record);
    if (odometry == nullptr || !is_stray(*odometry)) return record;
  }
  return std::nullopt;
}

bool WithoutStrayOdometry::is_stray(const OdometryRecord& record) {
  const auto kind = static_cast<std::size_t>(record.kind);
  return stray_.lines[kind].contains(lines_[kind]++);
}

void WithoutStrayOdometry::mend(LaserRecord& record) {
  const StrayOdometry::Scanner scanner{record.kind, record.slot};
  const auto stray = stray_.scans.find(scanner);
  const std::size_t number = scans_[scanner]++;
  if (stray == stray_.scans.end()) return;
  const auto found = stray->second.find(number);
  if (found != stray->second.end()) record.wheel_from_base = found->second;
}

}  // namespace slammot::files
