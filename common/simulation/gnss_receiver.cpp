#include "common/simulation/gnss_receiver.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace slammot::simulation {
namespace {

using geometry::Matrix2;
using geometry::Vector2;

constexpr std::size_t kFewest = 4;
constexpr double kWorstHdop = 10.0;

Outline walls_of(const Outline& outline) {
  Outline walls;
  for (const Segment& segment : outline.segments) {
    if (segment.material == Material::wall) walls.segments.push_back(segment);
  }
  return walls;
}

}  // namespace

GnssReceiver::GnssReceiver(const GnssConfig& config, const Outline& stationary_in_world,
                           std::uint64_t seed)
    : config_(config),
      buildings_(walls_of(stationary_in_world)),
      random_(seed, Purpose::gnss),
      wander_east_(random_),
      wander_north_(random_),
      multipath_east_(random_),
      multipath_north_(random_) {
  for (int i = 0; i < config.satellites; ++i) {  // evenly over the sky
    const double azimuth_rad = random_.uniform(-std::numbers::pi, std::numbers::pi);
    satellites_.push_back(
        {azimuth_rad, std::asin(random_.uniform(std::sin(config.lowest_rad), 1.0))});
  }
}

bool GnssReceiver::is_hidden(const Satellite& satellite, const Vector2& place_in_world) const {
  const double above_m = config_.building_height_m - config_.antenna_height_m;
  const double reach_m = above_m / std::tan(satellite.elevation_rad);  // farther buildings do not
                                                                       // hide the satellite
  const Vector2 direction{std::cos(satellite.azimuth_rad), std::sin(satellite.azimuth_rad)};
  return std::isfinite(buildings_.cast(place_in_world, direction, reach_m).range_m);
}

sensing::GnssFix GnssReceiver::fix(const geometry::Pose2& world_from_base, double after_s,
                                   double moved_m) {
  for (DriftingError* error : {&wander_east_, &wander_north_})
    error->advance(after_s, config_.wander_s, random_);
  for (DriftingError* error : {&multipath_east_, &multipath_north_})
    error->advance(moved_m, config_.multipath_length_m, random_);
  const Vector2 noise{random_.normal(), random_.normal()};
  const Vector2 place = world_from_base.translation_m();
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  std::size_t used = 0;
  for (const Satellite& satellite : satellites_) {
    if (is_hidden(satellite, place)) continue;
    const double level = std::cos(satellite.elevation_rad);
    const Eigen::Vector4d row{level * std::cos(satellite.azimuth_rad),
                              level * std::sin(satellite.azimuth_rad),
                              std::sin(satellite.elevation_rad), 1.0};
    information += row * row.transpose();
    ++used;
  }
  sensing::GnssFix fix;
  fix.satellites = static_cast<int>(used);
  if (used < kFewest) return fix;
  const Matrix2 dilution = Eigen::Matrix4d(information.inverse()).topLeftCorner<2, 2>();
  fix.hdop = std::sqrt(dilution.trace());
  if (!(fix.hdop <= kWorstHdop)) return fix;
  fix.quality = sensing::GnssQuality::single;
  const Matrix2 scatter_m2 = config_.range_error_m * config_.range_error_m * dilution;
  fix.covariance_m2 = scatter_m2 + config_.wander_m * config_.wander_m * Matrix2::Identity();
  const double hidden_share =
      1.0 - static_cast<double>(used) / static_cast<double>(satellites_.size());
  const Vector2 error_m = Matrix2(scatter_m2.llt().matrixL()) * noise +
                          config_.wander_m * Vector2(wander_east_.value(), wander_north_.value()) +
                          hidden_share * config_.multipath_m *
                              Vector2(multipath_east_.value(), multipath_north_.value());
  fix.position =
      geometry::geodetic_at({config_.latitude_deg, config_.longitude_deg}, place + error_m);
  fix.altitude_m = config_.altitude_m;
  return fix;
}

}  // namespace slammot::simulation
