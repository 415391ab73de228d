#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/files/record_filter.hpp"

namespace slammot::files {

/// Records of a log without scans that were recorded again: by a relay, by two recorders, by a
/// driver that publishes twice. Such a scan has the scanner, the stamp and the readings of one of
/// the last scans. Poses by odometry that are repeated so are left out, too. Where stamps do not
/// tell records apart nothing is left out.
class WithoutRepeatedScans : public RecordFilter {
 public:
  explicit WithoutRepeatedScans(std::unique_ptr<RecordSource> records)
      : RecordFilter(std::move(records)) {}

  std::optional<CarmenRecord> next() override;
  std::uint64_t repeated_scans() const override { return repeated_; }

 private:
  static constexpr std::size_t kKept = 16;

  struct Seen {
    LaserRecordKind kind = LaserRecordKind::kFlaser;
    std::uint8_t slot = 0;
    std::int64_t stamp_ns = 0;
    std::size_t readings = 0;  ///< Their hash.
  };
  bool is_repeated(const LaserRecord& record);
  bool is_repeated(const OdometryRecord& record);

  std::array<Seen, kKept> seen_{};  ///< Ring buffer.
  std::size_t next_seen_ = 0;
  std::optional<OdometryRecord> last_pose_;
  bool stamp_advanced_ = true;  ///< From the pose before to the last one.
  std::uint64_t repeated_ = 0;
};

}  // namespace slammot::files
