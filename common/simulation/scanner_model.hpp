#pragma once

#include <string>
#include <vector>

#include "common/sensing/scan.hpp"
#include "common/simulation/moving_object.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/ray_caster.hpp"
#include "common/simulation/terrain.hpp"

namespace slammot::simulation {

/// Model of the range noise.
enum class RangeNoise {
  as_given,      ///< By noise_floor_m and noise_per_m.
  data_sheet,    ///< SICK LMS 2xx: 0.01 m, one sigma, at any range.
  conservative,  ///< 1 % of the range (Wang 2004, Section 3.1).
};

/// One planar scanner; the defaults are a SICK LMS291 (datasheet: 0.5 degrees, spots of about 0.44
/// degrees, 1/75 s for 180 degrees) with the noise seen in recordings of one.
struct ScannerConfig {
  std::string scanner_id = "front";
  double ahead_m = 2.15;       ///< Of the vehicle's centre,
  double left_m = 0.0;         ///< and beside it.
  double heading_rad = 0.0;    ///< Where it looks, counter-clockwise from straight ahead,
  double nose_down_rad = 0.0;  ///< how far it is tipped forward,
  double left_up_rad = 0.0;  ///< and to its right; a quarter turn makes it scan a vertical profile.
  double height_m = 0.6;
  int beams = 361;
  double first_beam_rad = -1.570796;
  double field_of_view_rad = 3.141593;
  double rate_hz = 37.5;
  double delay_s = 0.0;         ///< Of its first scan behind that of the vehicle's first scanner.
  double sweep_s = 1.0 / 75.0;  ///< From the first to the last beam.
  double max_range_m = 81.83;   ///< Reading for "no echo".
  double resolution_m = 0.01;
  RangeNoise noise = RangeNoise::as_given;
  double noise_floor_m = 0.012;  ///< One sigma at no distance.
  double noise_per_m = 0.0013;   ///< Growth of sigma with range.
  double spot_rad = 0.0077;      ///< Full width of the beam.
  double mixed_share = 0.4;  ///< Of the spots split over an edge: reading between the two surfaces.
  double drop_out = 0.002;   ///< Echo lost at no distance.
  double dark_drop_out = 0.15;  ///< Echo from a car lost at maximum range; grows with the square of
                                ///< range.
};

/// Moving part of the world at one time.
struct Moment {
  geometry::Pose2 world_from_base;
  double nose_down_rad = 0.0;         ///< Of the body, by the road and by its springs.
  std::vector<MovingObject> objects;  ///< The same objects in the same order at every moment.
};

/// A step of the simulation: motion is uniform between the two moments and beyond.
struct Step {
  const Moment& before;
  const Moment& after;
  double duration_s;
  const Terrain& terrain = kLevelRoad;
  double sweep_after_s = 0.0;  ///< From `before` to the sweep's first beam.
};

constexpr int kStationary = -1;
constexpr int kNothing = -2;
constexpr int kMixed = -3;  ///< A mixed pixel of two surfaces that are not both stationary.

struct ScannedWorld {
  std::vector<float> range_m;  ///< One a beam.
  std::vector<int> source;     ///< Source of each echo: index of a moving object, kStationary,
                               ///< kNothing or kMixed.
};

/// The scanner's geometry as in its scans, without the tilt.
sensing::Scanner scanner_of(const ScannerConfig& config);

/// True if its scans are vertical profiles, of no use for a planar map.
bool scans_vertically(const ScannerConfig& config);

/// One sigma at that range.
double range_sigma_m(const ScannerConfig& config, double range_m);

/// One sweep that starts in the step: beams fire one after the other while vehicle and objects
/// move, each spot is as wide as the real one's and may be split by an edge, braking and slopes tip
/// the beams into the road or over what is low.
ScannedWorld scan_world(const ScannerConfig& config, const RayCaster& stationary, const Step& step,
                        Random& random);

}  // namespace slammot::simulation
