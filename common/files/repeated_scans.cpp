#include "common/files/repeated_scans.hpp"

#include <functional>
#include <string_view>
#include <utility>
#include <variant>

namespace slammot::files {
namespace {

/// Of the scanner, or else of the logger; 0 for none.
std::int64_t stamp_that_tells(const CarmenStamps& stamps) {
  const std::int64_t ipc_ns = stamps.ipc_ns.value_or(0);
  return ipc_ns != 0 ? ipc_ns : stamps.logger_ns.value_or(0);
}

std::size_t hash_of(const std::vector<float>& readings) {
  return std::hash<std::string_view>{}(
      {reinterpret_cast<const char*>(readings.data()), readings.size() * sizeof(float)});
}

}  // namespace

std::optional<CarmenRecord> WithoutRepeatedScans::next() {
  while (auto record = records().next()) {
    const auto* const scan = std::get_if<LaserRecord>(&*record);
    const auto* const pose = std::get_if<OdometryRecord>(&*record);
    if (pose != nullptr && is_repeated(*pose)) continue;
    if (scan == nullptr || !is_repeated(*scan)) return record;
    ++repeated_;
  }
  return std::nullopt;
}

bool WithoutRepeatedScans::is_repeated(const LaserRecord& record) {
  const Seen now{record.kind, record.slot, stamp_that_tells(record.stamps),
                 hash_of(record.range_m)};
  if (now.stamp_ns == 0) return false;
  bool is_seen = false;
  bool is_another = false;
  for (const Seen& before : seen_) {
    if (before.kind != now.kind || before.slot != now.slot || before.stamp_ns != now.stamp_ns)
      continue;
    (before.readings == now.readings ? is_seen : is_another) = true;
  }
  if (is_seen && !is_another) return true;
  seen_[next_seen_++ % kKept] = now;
  return false;
}

bool WithoutRepeatedScans::is_repeated(const OdometryRecord& record) {
  const std::int64_t stamp_ns = stamp_that_tells(record.stamps);
  const bool is_of_last_stamp = last_pose_ && last_pose_->kind == record.kind &&
                                stamp_that_tells(last_pose_->stamps) == stamp_ns;
  if (stamp_ns != 0 && is_of_last_stamp && stamp_advanced_ &&
      last_pose_->wheel_from_base == record.wheel_from_base)
    return true;
  stamp_advanced_ = !is_of_last_stamp;
  last_pose_ = record;
  return false;
}

}  // namespace slammot::files
