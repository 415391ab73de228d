#pragma once

#include <optional>

#include <Eigen/Core>

#include "services/tracking/footprint.hpp"
#include "services/tracking/observation.hpp"
#include "services/tracking/size_evidence.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Widest road user [m], before scaling.
inline constexpr double kWidestM = 3.2;

/// Log-odds at which it is sure which side of a box is its flank: twenty to one.
inline constexpr double kSureOdds = 3.0;

/// The axis of a box counts as measured by its sides below this variance.
inline constexpr double kKnownAxisRad2 = 0.02;

/// End of each size from which the centre was last measured: -1 rear or right side, +1 front or
/// left side, 0 both; none before.
struct Anchors {
  std::optional<int> length;
  std::optional<int> width;
};

/// Extent of an object with straight sides. The footprint holds the posterior of the sizes; the
/// evidence is kept beside it. Invariant: length and width are those of with_likely_sizes(), given
/// evidence, corner and road users.
struct Box : Footprint {
  double heading_variance_rad2 = 10.0;
  bool is_oriented = false;  ///< Which side is the length is known, from the course or because it
                             ///< is long.
  double axis_rad = 0.0;     ///< Direction of the length by the visible sides alone, without the
                             ///< course; modulo a quarter turn.
  double axis_variance_rad2 = 10.0;
  SizesSeen evidence;
  Size corner_seen = {0.0, kUnknownSizeM2};  ///< Measured depth of the corners.
  Kind kind = Kind::kCar;                    ///< The likeliest kind of road user.
  Anchors anchors;
};

/// The box with sizes and kind as they follow from its evidence: a mixture over the kinds of road
/// users, of which the likeliest gives the mean and all give the variance.
Box with_likely_sizes(Box box, const TrackingConfig& config);

/// Log-likelihood of the evidence under the mixture of kinds, up to a constant.
double log_evidence_of_sizes(const Box& box, const TrackingConfig& config);

/// Evidence with the part that corners hide added: corners of a vehicle, or none for a bicycle.
struct EvidenceByKind {
  SizesSeen of_bicycle;
  SizesSeen of_vehicle;

  const SizesSeen& of(Kind kind) const { return kind == Kind::kBicycle ? of_bicycle : of_vehicle; }
};

EvidenceByKind evidence_by_kind(const Box& box, const TrackingConfig& config);

/// Posterior depth of the corners of a box of this kind; zero for bicycles and where only people
/// move.
Size corner_of(const Box& box, Kind kind, const TrackingConfig& config);

/// Box around an object seen for the first time. box_heading_rad: of the longer visible side, sense
/// unknown. A single short side is taken for the width, with a large heading variance. The box
/// refers to the road users.
Box likely_box(double box_heading_rad, const Observation& observation, const TrackingConfig& config,
               const RoadUsers& road_users = kRoadUsersAnywhere);

/// Centre of the box if the observation is all that is known of its position: the hidden part lies
/// behind the visible one.
Eigen::Vector2d supposed_centre_m(const Box& box, const Observation& observation);

/// Front and rear exchanged.
Box turned_about(Box box);

/// Length and width exchanged; the heading turns by a quarter in this sense (sign). Measurements
/// from edge to edge are discarded.
Box turned_by_a_quarter(Box box, double sense, const TrackingConfig& config);

/// False if the evidence exceeds the size of every road user: the echoes are of several objects.
bool is_plausible(const Box& box, const TrackingConfig& config);

}  // namespace slammot::tracking
