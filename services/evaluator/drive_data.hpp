#pragma once

#include <string>

#include "services/evaluator/report_picture.hpp"
#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// A drive in the form in which page/recording.js reads it.
struct DriveData {
  std::string header;  ///< JSON: columns, place of the map, graph, doubtful times.
  std::string bytes;   ///< The columns: little-endian, each at a multiple of four bytes.
};

/// Poses and tracks ten times a second or less often, so that a long drive stays below about 6 MB.
/// Tracks are moved with the corrected poses of the vehicle, so that they fit the map.
///
/// One value a frame: time [s], x, y [m], heading [rad], var_x, cov_xy, var_y [m^2] of the vehicle
/// in map; first_row of its tracks (one more value at the end). One value a row: track (its id),
/// track_x, track_y [m], track_heading [1e-4 rad], vx, vy [cm/s], length, width [0.1 m], existence
/// [1/65535], sigma_x, sigma_y [mm], correlation [1/127], mode_0 to mode_2 [1/255], flags (class in
/// three bits, 8: moving, 16: occluded).
DriveData encode_drive(const RunResult& result, const ReportPicture* picture);

}  // namespace slammot::evaluator
