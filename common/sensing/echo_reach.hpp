#pragma once

#include <string>
#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// How far the echoes of each scanner have reached on a drive, which may be much less than the
/// range that is stated. Nothing answers from farther away: a beam without an echo tells of free
/// space up to there only. Allocates at the first scan of a scanner only.
class EchoReach {
 public:
  void add(const LaserScan& scan);

  /// 0 before the scanner's first scan.
  double reach_m(const std::string& scanner_id) const;

 private:
  struct Reach {
    std::string scanner_id;
    double reach_m;
  };
  std::vector<Reach> reaches_;
};

}  // namespace slammot::sensing
