#include "common/files/repeated_scans.hpp"

#include <deque>
#include <utility>

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

constexpr std::int64_t kStampUnit_ns = 1'000'000'000;

class Records : public RecordSource {
 public:
  explicit Records(std::deque<CarmenRecord> records) : records_(std::move(records)) {}

  std::optional<CarmenRecord> next() override {
    if (records_.empty()) return std::nullopt;
    CarmenRecord record = std::move(records_.front());
    records_.pop_front();
    ++line_;
    return record;
  }
  std::uint64_t line_number() const override { return line_; }
  double fraction_read() const override { return 0.0; }

 private:
  std::deque<CarmenRecord> records_;
  std::uint64_t line_ = 0;
};

LaserRecord scan(std::int64_t stamp_s, float range_m, std::uint8_t slot = 1) {
  LaserRecord record;
  record.slot = slot;
  record.range_m = {range_m, 2.0F};
  if (stamp_s != 0) record.stamps.ipc_ns = stamp_s * kStampUnit_ns;
  return record;
}

OdometryRecord pose(std::int64_t stamp_s, double x_m) {
  OdometryRecord record;
  record.wheel_from_base.x_m = x_m;
  record.stamps.ipc_ns = stamp_s * kStampUnit_ns;
  return record;
}

struct Left {
  std::size_t scans = 0, poses = 0;
  std::uint64_t repeated_scans = 0;
};

Left left_of(std::deque<CarmenRecord> records) {
  WithoutRepeatedScans without(std::make_unique<Records>(std::move(records)));
  Left left;
  while (const auto record = without.next()) {
    left.scans += std::holds_alternative<LaserRecord>(*record);
    left.poses += std::holds_alternative<OdometryRecord>(*record);
  }
  left.repeated_scans = without.repeated_scans();
  return left;
}

TEST(WithoutRepeatedScans, LeavesOutAScanThatIsRecordedAgain) {
  const Left left = left_of(
      {scan(1, 5.0F), scan(1, 5.0F), scan(2, 5.0F), scan(3, 6.0F), scan(2, 5.0F), scan(4, 6.0F)});
  EXPECT_EQ(left.scans, 4U);
  EXPECT_EQ(left.repeated_scans, 2U);
}

TEST(WithoutRepeatedScans, KeepsScansOfOneStampThatDiffer) {
  EXPECT_EQ(left_of({scan(1, 5.0F), scan(1, 6.0F), scan(1, 5.0F)}).scans, 3U)
      << "stamps do not tell these apart";
  EXPECT_EQ(left_of({scan(1, 5.0F, 1), scan(1, 5.0F, 2)}).scans, 2U) << "two scanners";
}

TEST(WithoutRepeatedScans, KeepsScansWithoutStamp) {
  EXPECT_EQ(left_of({scan(0, 5.0F), scan(0, 5.0F), scan(0, 5.0F)}).scans, 3U);
}

TEST(WithoutRepeatedScans, LeavesOutPosesThatAreRecordedAgain) {
  EXPECT_EQ(left_of({pose(1, 0.0), pose(1, 0.0), pose(2, 0.0), pose(2, 0.0)}).poses, 2U);
}

TEST(WithoutRepeatedScans, KeepsPosesOfOneStampThatDifferAndAllAfterThem) {
  EXPECT_EQ(left_of({pose(1, 0.0), pose(1, 1.0), pose(1, 1.0), pose(1, 1.0)}).poses, 4U)
      << "the clock stands";
}

}  // namespace
}  // namespace slammot::files
