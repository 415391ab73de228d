#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::files {

/// Tests whether interpolated ODOM lines equal the poses of the laser records. Stamps are times, or
/// numbers of lines.
class OdometryAgreement {
 public:
  void add_odom(const sensing::Odometry& odom);
  void add_laser(const sensing::Odometry& laser);
  bool agrees() const;

 private:
  std::optional<sensing::Odometry> before_;
  std::vector<sensing::Odometry> waiting_;
  std::uint64_t compared_ = 0;
  std::uint64_t met_ = 0;
};

}  // namespace slammot::files
