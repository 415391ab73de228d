#include "services/tracking/merging.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "services/tracking/beam_run.hpp"
#include "services/tracking/confirmation.hpp"
#include "services/tracking/extent_update.hpp"
#include "services/tracking/observing.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// Share of b's footprint inside a's, sampled.
double overlap_share(const Track& a, const Track& b) {
  constexpr int kAlong = 7;
  constexpr int kAcross = 3;
  const double reach_m = 0.5 * (a.footprint().length.value_m + a.footprint().width.value_m +
                                b.footprint().length.value_m + b.footprint().width.value_m);
  if ((a.position_m() - b.position_m()).squaredNorm() > reach_m * reach_m) return 0.0;
  const Vector2d along =
      b.footprint().length.value_m *
      Vector2d(std::cos(b.footprint().heading_rad), std::sin(b.footprint().heading_rad));
  const Vector2d across =
      b.footprint().width.value_m *
      Vector2d(-std::sin(b.footprint().heading_rad), std::cos(b.footprint().heading_rad));
  int inside = 0;
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j) {
      const Vector2d point_m = b.position_m() + ((i + 0.5) / kAlong - 0.5) * along +
                               ((j + 0.5) / kAcross - 0.5) * across;
      inside += is_inside(a.footprint(), a.position_m(), 0.0, point_m) ? 1 : 0;
    }
  return static_cast<double>(inside) / (kAlong * kAcross);
}

/// True if the small object is a part of the vehicle's side.
bool is_part_of(const Track& vehicle, const Track& part, const TrackingConfig& config) {
  constexpr double kMostEchoesShare = 0.25;
  constexpr double kMovingMps = 2.0;
  if (!is_vehicle(vehicle) || is_vehicle(part) || !vehicle.existence.confirmed ||
      part.existence.mean_echoes > kMostEchoesShare * vehicle.existence.mean_echoes)
    return false;
  if (vehicle.velocity_mps().norm() < kMovingMps ||
      (vehicle.velocity_mps() - part.velocity_mps()).norm() >
          1.5 + 0.2 * vehicle.velocity_mps().norm())
    return false;
  return is_inside(vehicle.footprint(), vehicle.position_m(), config.association.gate_margin_m,
                   part.position_m());
}

/// True if no part of one is near a part of the other.
bool are_far_apart(const Track& a, const Track& b, const TrackingConfig& config) {
  const double sizes_m = a.footprint().length.value_m + a.footprint().width.value_m +
                         b.footprint().length.value_m + b.footprint().width.value_m;
  const double reach_m = 0.5 * sizes_m + 2.0 * config.association.gate_margin_m +
                         config.extent.stride_m + config.extent.merge_overlap_m;
  return (a.position_m() - b.position_m()).squaredNorm() > reach_m * reach_m;
}

/// True if the vehicle cannot be where a known pedestrian is seen as recently.
bool is_pedestrian_inside(const Track& pedestrian, const Track& vehicle) {
  return is_known_pedestrian(pedestrian) && is_vehicle(vehicle) &&
         pedestrian.history.last_seen_ns >= vehicle.history.last_seen_ns;
}

bool extents_coincide(const Track& a, const Track& b, const TrackingConfig& config) {
  if (is_part_of(a, b, config)) return true;
  // Nothing can be inside a vehicle; smaller tracks may be several pedestrians.
  const bool excludes_others =
      (a.existence.confirmed && is_vehicle(a)) || is_pedestrian_inside(a, b);
  if (!excludes_others &&
      (a.velocity_mps() - b.velocity_mps()).norm() > 1.5 + 0.2 * a.velocity_mps().norm())
    return false;
  constexpr double kMostOverlap = 0.35;
  if ((a.existence.confirmed || b.existence.confirmed) && is_vehicle(a) && is_vehicle(b) &&
      std::max(overlap_share(a, b), overlap_share(b, a)) > kMostOverlap)
    return true;
  const bool b_in_a =
      is_inside(a.footprint(), a.position_m(), -config.extent.merge_overlap_m, b.position_m());
  const bool a_in_b =
      is_inside(b.footprint(), b.position_m(), -config.extent.merge_overlap_m, a.position_m());
  if (a.extent.box() != nullptr || b.extent.box() != nullptr) return b_in_a || a_in_b;
  constexpr int kLongKnownHits = 75;
  constexpr double kLikeMps = 0.8;  // legs of one pedestrian, not two who pass each other
  const bool are_long_known = a.existence.confirmed && b.existence.confirmed &&
                              std::min(a.existence.hits, b.existence.hits) >= kLongKnownHits;
  if (are_long_known && (a.velocity_mps() - b.velocity_mps()).norm() > kLikeMps) return false;
  const bool is_young = a.existence.hits < 20 || b.existence.hits < 20;  // two pedestrians side by
                                                                         // side are not merged
  return (a.position_m() - b.position_m()).norm() <
         (is_young ? config.extent.stride_m : config.extent.merge_overlap_m);
}

/// Mostly without the square root.
bool is_longer(const Vector2d& way_m, double than_m) {
  constexpr double kSurely = 1.0 + 1e-9;
  return way_m.squaredNorm() > kSurely * than_m * than_m || way_m.norm() > than_m;
}

/// Rank of two tracks of one object. One that has few of the echoes of which the other has many is
/// no object.
bool outranks(const Track& a, const Track& b, const TrackingConfig& config) {
  if (is_part_of(a, b, config)) return true;
  if (is_part_of(b, a, config)) return false;
  if (is_pedestrian_inside(a, b)) return true;
  if (is_pedestrian_inside(b, a)) return false;
  const auto has_remainder_of = [](const Track& one, const Track& other) {
    constexpr double kFew = 3.0;
    constexpr double kRemainderShare = 0.25;
    return one.existence.mean_echoes < kFew &&
           one.existence.mean_echoes < kRemainderShare * other.existence.mean_echoes;
  };
  if (has_remainder_of(a, b)) return false;
  if (has_remainder_of(b, a)) return true;
  if (const Track* wrong = inconsistent_one(a, b, config)) return wrong == &b;
  if (a.existence.confirmed != b.existence.confirmed) return a.existence.confirmed;
  return a.track_id < b.track_id;
}

bool is_long_known(const Track& track) {
  constexpr int kLongKnownHits = 10;
  return track.existence.confirmed && track.existence.hits >= kLongKnownHits;
}

/// Gives one track the echoes of the other, which is marked for removal.
void absorb(std::vector<Track>& tracks, Associations& associations, std::size_t into,
            std::size_t from) {
  tracks[from].existence.hits = 0;
  move_beams(associations, from, into);
}

}  // namespace

bool is_duplicate(const Track& track, const Track& other, const TrackingConfig& config) {
  return !are_far_apart(other, track, config) && outranks(other, track, config) &&
         extents_coincide(other, track, config);
}

bool are_parts_of_one_vehicle(const Track& a, const Track& b, const TrackingConfig& config) {
  constexpr double kSlowVehicleMps = 1.0;
  constexpr double kCarLengthM = 4.9;
  constexpr double kCarWidthM = 2.1;
  constexpr double kTruckLengthM = 8.2;
  constexpr double kTruckWidthM = 2.6;
  if (is_longer(a.position_m() - b.position_m(), 2.0 * kCarLengthM * config.extent.size_scale))
    return false;
  const double least_mps = is_vehicle(a) && is_vehicle(b) ? kSlowVehicleMps : kFastestWalkMps;
  const Vector2d velocity_mps = 0.5 * (a.velocity_mps() + b.velocity_mps());
  const double speed_mps = velocity_mps.norm();
  if (speed_mps < least_mps || (a.velocity_mps() - b.velocity_mps()).norm() > 0.4 + 0.1 * speed_mps)
    return false;
  const Vector2d along = velocity_mps / speed_mps;
  const Vector2d across{-along.y(), along.x()};
  Eigen::AlignedBox2d seen;
  for (const auto* contour : {&a.extent.contour_in_odom_m, &b.extent.contour_in_odom_m})
    for (const Eigen::Vector2f& point : *contour)
      seen.extend(Vector2d(along.dot(point.cast<double>()), across.dot(point.cast<double>())));
  if (seen.sizes().x() < kCarLengthM * config.extent.size_scale &&
      seen.sizes().y() < kCarWidthM * config.extent.size_scale)
    return true;
  const double longest_m =
      std::max({seen.sizes().x(), a.footprint().length.value_m, b.footprint().length.value_m});
  return a.extent.box() != nullptr && longest_m < kTruckLengthM * config.extent.size_scale &&
         seen.sizes().y() < kTruckWidthM * config.extent.size_scale &&
         std::max(overlap_share(a, b), overlap_share(b, a)) > 0.0;
}

std::uint64_t join_parts(std::vector<Track>& tracks, Associations& associations,
                         const ScanContext& context) {
  std::uint64_t joined = 0;
  const auto may_be_joined = [&](std::size_t t) {
    return is_long_known(tracks[t]) && associations.has_echoes(t);
  };
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    for (std::size_t b = 0; b < tracks.size() && may_be_joined(a); ++b) {
      if (a == b || tracks[a].existence.hits < tracks[b].existence.hits || !may_be_joined(b))
        continue;
      TrackShare& share = associations.shares[a];
      if (!are_parts_of_one_vehicle(tracks[a], tracks[b], context.config) ||
          is_seen_between(share.beams, associations.shares[b].beams, context.view.polar()))
        continue;
      absorb(tracks, associations, a, b);
      const Observation whole =
          observe(share, swept_motion(tracks[a]), tracks[a].extent.responses, context);
      reinitialise_extent(tracks[a], whole, context.config);
      ++joined;
    }
  }
  return joined;
}

std::uint64_t merge_duplicates(std::vector<Track>& tracks, Associations& associations,
                               const TrackingConfig& config) {
  std::uint64_t merged = 0;
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    for (std::size_t b = 0; b < tracks.size(); ++b) {
      if (a == b || tracks[b].existence.hits == 0 || tracks[a].existence.hits == 0 ||
          tracks[a].history.is_hidden || tracks[b].history.is_hidden ||
          !is_duplicate(tracks[b], tracks[a], config))
        continue;
      absorb(tracks, associations, a, b);
      ++merged;
    }
  }
  return merged;
}

}  // namespace slammot::tracking
