#include "common/simulation/scanner_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/sensing/spatial_mounting.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kSplit_m = 0.4;  ///< Rays of a spot with a larger range difference are on two
                                  ///< surfaces.
constexpr double kGroundDropOut = 0.3;  ///< The beam meets the road at grazing incidence.
constexpr double kFoliageDropOut = 0.1;
constexpr double kFoliageDepth_m = 0.4;  ///< Penetration depth of a beam into foliage.

struct Echo {
  double range_m = kInfinity;
  Material material = Material::wall;
  int source = kNothing;
};

Pose2 base_from_laser(const ScannerConfig& config) {
  return {config.ahead_m, config.left_m, config.heading_rad};
}

/// Index range of the beams that may hit each object, so that a beam tests few objects.
class Candidates {
 public:
  Candidates(const ScannerConfig& config, const Step& step)
      : by_beam_(static_cast<std::size_t>(config.beams)) {
    for (std::size_t i = 0; i < step.before.objects.size(); ++i)
      add(config, step, static_cast<int>(i));
  }
  const std::vector<int>& of_beam(int beam) const {
    return by_beam_[static_cast<std::size_t>(beam)];
  }
  /// Bound of the object's motion during the sweep.
  double reach_m(int object) const { return reaches_m_[static_cast<std::size_t>(object)]; }

 private:
  void add(const ScannerConfig& config, const Step& step, int object) {
    const MovingObject& before = step.before.objects[static_cast<std::size_t>(object)];
    const MovingObject& after = step.after.objects[static_cast<std::size_t>(object)];
    const Pose2 world_from_laser = step.before.world_from_base * base_from_laser(config);
    const Vector2 in_laser = inverse(world_from_laser) * before.world_from_object.translation_m();
    // Bound of the displacement by translation and rotation during the sweep; a stride can exceed a
    // small box most. out of a small box.
    const double steps = std::max(1.0, (step.sweep_after_s + config.sweep_s) / step.duration_s);
    const double moved_m =
        steps *
        ((after.world_from_object.translation_m() - before.world_from_object.translation_m())
             .norm() +
         (step.after.world_from_base.translation_m() - step.before.world_from_base.translation_m())
             .norm());
    const double radius_m =
        0.5 * std::hypot(before.size.length_m, before.size.width_m) + moved_m + 0.5;
    reaches_m_.push_back(radius_m);
    const double distance_m = in_laser.norm();
    if (distance_m > config.max_range_m + radius_m) return;
    int first = 0;
    int last = config.beams - 1;
    if (distance_m > radius_m) {
      const double turned_rad =
          steps * std::abs(geometry::wrap_angle(step.after.world_from_base.heading_rad -
                                                step.before.world_from_base.heading_rad));
      const double half_rad = std::asin(radius_m / distance_m) + turned_rad + config.spot_rad;
      const double beam_step_rad = config.field_of_view_rad / (config.beams - 1);
      const double bearing_rad = std::atan2(in_laser.y(), in_laser.x());
      first = std::max(
          first, static_cast<int>(
                     std::floor((bearing_rad - half_rad - config.first_beam_rad) / beam_step_rad)));
      last = std::min(last, static_cast<int>(std::ceil(
                                (bearing_rad + half_rad - config.first_beam_rad) / beam_step_rad)));
      // Behind a half-circle scanner the interval is empty; for a full-circle scanner the object
      // lies across the cut. A strongly tilted scanner's beams do not follow their indices in the
      // plane.
      const bool is_tipped = std::abs(config.left_up_rad) + std::abs(config.nose_down_rad) > 0.2;
      if (config.field_of_view_rad > 3.2 || is_tipped) first = 0, last = config.beams - 1;
    }
    for (int beam = first; beam <= last; ++beam)
      by_beam_[static_cast<std::size_t>(beam)].push_back(object);
  }

  std::vector<std::vector<int>> by_beam_;
  std::vector<double> reaches_m_;
};

/// The world at the moment when one beam fires.
struct BeamView {
  Pose2 world_from_laser;
  double nose_down_rad;
  double fraction;  ///< Elapsed fraction of the step.
  const std::vector<int>& candidates;
};

double range_to_object(const MovingObject& object, const Pose2& world_from_object,
                       const Vector2& origin, const Vector2& direction) {
  const Pose2 object_from_world = inverse(world_from_object);
  const Vector2 origin_in_object = object_from_world * origin;
  const Vector2 direction_in_object = geometry::rotation(object_from_world.heading_rad) * direction;
  double range_m = kInfinity;
  for (const Segment& segment : object.outline_in_object.segments) {
    range_m = std::min(range_m, distance_along_ray(segment, origin_in_object, direction_in_object));
  }
  for (const Circle& circle : object.outline_in_object.circles) {
    range_m = std::min(range_m, distance_along_ray(circle, origin_in_object, direction_in_object));
  }
  return range_m;
}

/// True if the ray cannot hit anything within reach of the object's position.
bool passes_by(const MovingObject& before, double reach_m, const Vector2& origin,
               const Vector2& direction) {
  const Vector2 to_object = before.world_from_object.translation_m() - origin;
  return std::abs(direction.x() * to_object.y() - direction.y() * to_object.x()) > reach_m;
}

/// A beam in space: its direction over the ground, and its rise per metre of that.
struct BeamDirection {
  Vector2 in_world;
  double rise;
  double level_share;  ///< Of its length: the part along the ground.
};

/// heading_rad: of the scanner in the world. Right-handed turns: about x by left_up_rad, then about
/// y by nose_down_rad.
BeamDirection direction_of(double beam_rad, double heading_rad, double nose_down_rad,
                           double left_up_rad) {
  if (nose_down_rad == 0.0 && left_up_rad == 0.0)
    return {{std::cos(heading_rad + beam_rad), std::sin(heading_rad + beam_rad)}, 0.0, 1.0};
  const double rolled_up = std::sin(beam_rad) * std::sin(left_up_rad);
  const double ahead =
      std::cos(beam_rad) * std::cos(nose_down_rad) + rolled_up * std::sin(nose_down_rad);
  const double left = std::sin(beam_rad) * std::cos(left_up_rad);
  const double up =
      rolled_up * std::cos(nose_down_rad) - std::cos(beam_rad) * std::sin(nose_down_rad);
  const double level = std::max(1e-6, std::hypot(ahead, left));
  return {geometry::rotation(heading_rad) * Vector2(ahead / level, left / level), up / level,
          level};
}

class Sweep {
 public:
  Sweep(const ScannerConfig& config, const RayCaster& stationary, const Step& step, Random& random)
      : config_(config),
        stationary_(stationary),
        step_(step),
        random_(random),
        candidates_(config, step) {}

  ScannedWorld run() {
    ScannedWorld scanned;
    for (int beam = 0; beam < config_.beams; ++beam) {
      const Echo echo = fire(beam);
      scanned.range_m.push_back(static_cast<float>(echo.range_m));
      scanned.source.push_back(echo.source);
    }
    return scanned;
  }

 private:
  Echo fire(int beam) {
    const double delay_s = config_.sweep_s * beam / (config_.beams - 1);
    const double fraction = (step_.sweep_after_s + delay_s) / step_.duration_s;
    const Pose2 world_from_base =
        interpolate(step_.before.world_from_base, step_.after.world_from_base, fraction);
    const BeamView view{world_from_base * base_from_laser(config_),
                        step_.before.nose_down_rad +
                            fraction * (step_.after.nose_down_rad - step_.before.nose_down_rad),
                        fraction, candidates_.of_beam(beam)};
    const double beam_rad =
        config_.first_beam_rad + config_.field_of_view_rad * beam / (config_.beams - 1);
    const double edge_rad = 0.4 * config_.spot_rad;
    return measured(over_spot(
        {cast(view, beam_rad - edge_rad), cast(view, beam_rad), cast(view, beam_rad + edge_rad)}));
  }

  Echo cast(const BeamView& view, double beam_rad) const {
    const BeamDirection beam =
        direction_of(beam_rad, view.world_from_laser.heading_rad,
                     view.nose_down_rad + config_.nose_down_rad, config_.left_up_rad);
    const Vector2 origin = view.world_from_laser.translation_m();
    const double z_m = step_.terrain.height_m(origin.x()) + config_.height_m;
    const double reach_m = config_.max_range_m * beam.level_share;
    Echo nearest;
    const double ground_m = step_.terrain.distance_to_ground(origin, beam.in_world, z_m, beam.rise);
    if (ground_m < reach_m) nearest = {ground_m, Material::ground, kStationary};
    const Hit hit = first_not_below(origin, beam, z_m, reach_m);
    if (hit.range_m < nearest.range_m) nearest = {hit.range_m, hit.material, kStationary};
    for (const int index : view.candidates) {
      const MovingObject& before = step_.before.objects[static_cast<std::size_t>(index)];
      const MovingObject& after = step_.after.objects[static_cast<std::size_t>(index)];
      if (passes_by(before, candidates_.reach_m(index), origin, beam.in_world)) continue;
      const Pose2 world_from_object =
          interpolate(before.world_from_object, after.world_from_object, view.fraction);
      const double range_m = range_to_object(before, world_from_object, origin, beam.in_world);
      if (range_m >= nearest.range_m ||
          passes_over(origin, beam, z_m, range_m, usual_height_m(before.kind)))
        continue;
      nearest = {range_m, Material::body, index};
    }
    nearest.range_m /= beam.level_share;
    return nearest;
  }

  bool passes_over(const Vector2& origin, const BeamDirection& beam, double z_m, double level_m,
                   double height_m) const {
    const double road_m = step_.terrain.height_m(origin.x() + level_m * beam.in_world.x());
    return z_m + beam.rise * level_m > road_m + height_m;
  }

  /// The first stationary surface that the beam does not pass above.
  Hit first_not_below(const Vector2& origin, const BeamDirection& beam, double z_m,
                      double reach_m) const {
    constexpr double kBeyond_m = 0.01;
    Hit hit = stationary_.cast(origin, beam.in_world, reach_m);
    double passed_m = 0.0;
    while (std::isfinite(hit.range_m) &&
           passes_over(origin, beam, z_m, passed_m + hit.range_m, usual_height_m(hit.material))) {
      passed_m += hit.range_m + kBeyond_m;
      hit = stationary_.cast(Vector2(origin + passed_m * beam.in_world), beam.in_world,
                             reach_m - passed_m);
    }
    hit.range_m += passed_m;
    return hit;
  }

  /// Range of the whole spot: that of its centre or, if an edge splits it, sometimes a range in
  /// between.
  Echo over_spot(const std::array<Echo, 3>& rays) {
    const auto [nearest, furthest] =
        std::minmax_element(rays.begin(), rays.end(),
                            [](const Echo& a, const Echo& b) { return a.range_m < b.range_m; });
    const bool split = furthest->range_m - nearest->range_m > kSplit_m;
    if (!split || !random_.chance(config_.mixed_share)) return rays[1];
    if (furthest->range_m > config_.max_range_m) return *nearest;
    Echo mixed = *nearest;
    mixed.range_m += random_.uniform() * (furthest->range_m - nearest->range_m);
    const bool are_stationary = nearest->source == kStationary && furthest->source == kStationary;
    mixed.source = are_stationary ? kStationary : kMixed;  // belongs to neither
    return mixed;
  }

  Echo measured(Echo echo) {
    const Echo nothing{config_.max_range_m, Material::wall, kNothing};
    if (echo.range_m >= config_.max_range_m || random_.chance(drop_out(echo))) return nothing;
    if (echo.material == Material::foliage) echo.range_m += random_.uniform(0.0, kFoliageDepth_m);
    echo.range_m += range_sigma_m(config_, echo.range_m) * random_.normal();
    echo.range_m =
        config_.resolution_m * std::round(std::max(0.0, echo.range_m) / config_.resolution_m);
    return echo.range_m < config_.max_range_m ? echo : nothing;
  }

  double drop_out(const Echo& echo) const {
    if (echo.material == Material::ground) return kGroundDropOut;
    if (echo.material == Material::foliage) return kFoliageDropOut;
    const double far = echo.range_m / config_.max_range_m;
    const bool car = echo.material == Material::body || echo.material == Material::parked_car;
    return config_.drop_out +
           (car ? config_.dark_drop_out : 0.1 * config_.dark_drop_out) * far * far;
  }

  const ScannerConfig& config_;
  const RayCaster& stationary_;
  const Step& step_;
  Random& random_;
  Candidates candidates_;
};

}  // namespace

sensing::Scanner scanner_of(const ScannerConfig& config) {
  sensing::Scanner scanner;
  scanner.scanner_id = config.scanner_id;
  scanner.base_from_laser = base_from_laser(config);
  scanner.first_beam_rad = config.first_beam_rad;
  scanner.beam_step_rad = config.field_of_view_rad / (config.beams - 1);
  scanner.max_range_m = config.max_range_m;
  scanner.sweep_s = config.sweep_s;
  return scanner;
}

bool scans_vertically(const ScannerConfig& config) {
  return sensing::scans_vertically(
      sensing::Tilt{config.height_m, config.left_up_rad, config.nose_down_rad});
}

double range_sigma_m(const ScannerConfig& config, double range_m) {
  constexpr double kDataSheetM = 0.01;
  constexpr double kConservativeShare = 0.01;
  switch (config.noise) {
    case RangeNoise::data_sheet: return kDataSheetM;
    case RangeNoise::conservative: return kConservativeShare * range_m;
    case RangeNoise::as_given: break;
  }
  return config.noise_floor_m + config.noise_per_m * range_m;
}

ScannedWorld scan_world(const ScannerConfig& config, const RayCaster& stationary, const Step& step,
                        Random& random) {
  return Sweep(config, stationary, step, random).run();
}

}  // namespace slammot::simulation
