#pragma once

#include <filesystem>
#include <fstream>

namespace slammot::ingest {

/// Writes a CARMEN log of `scans` scans of 5 beams, one every 0.1 s from 100 s on, of a vehicle
/// that moves forward at 1 m/s.
inline void write_small_log(const std::filesystem::path& file, int scans) {
  std::ofstream log(file);
  for (int i = 0; i < scans; ++i) {
    const double x_m = 0.1 * i;
    const double stamp_s = 100.0 + 0.1 * i;
    log << "FLASER 5 1.0 2.0 3.0 2.0 1.0 " << x_m << " 0 0 " << x_m << " 0 0 " << stamp_s << " car "
        << stamp_s << "\n";
  }
}

}  // namespace slammot::ingest
