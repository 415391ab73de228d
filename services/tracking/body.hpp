#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "services/tracking/road_users.hpp"

namespace slammot::tracking {

struct TrackingConfig;

/// What the scans said of a size so far.
struct SizeEvidence {
  double least_m = 0.0;               ///< So much was seen at once: it is not smaller.
  Size whole = {0.0, 1e6};            ///< Seen from edge to edge; a huge variance where it never was.
  double missed_share = 0.0;          ///< Of the depth of the body's corners, which has to be added to what was seen so.
};

/// What is known of an object's outline: a box with sides, or a blob without.
struct Body {
  bool has_sides = false;
  double heading_rad = 0.0;           ///< Of the length, in odom.
  double heading_variance_rad2 = 10.0;
  bool is_oriented = false;           ///< Which side is the length is known: by its course, or because it is long.
  double axis_rad = 0.0;              ///< Of the length, as its sides alone tell it, whatever the course.
  double axis_variance_rad2 = 10.0;
  Size length;                        ///< As believed, from the evidence and from what kinds of road users there are.
  Size width;
  SizeEvidence length_evidence;
  SizeEvidence width_evidence;
  Size corner_seen = {0.0, 1e6};      ///< How deep its corners are, as far as scans showed them; a huge variance where none did.
  bool was_seen_whole = false;        ///< Both ends of it at once, with something farther beside them; of a blob.
  Kind kind = Kind::kCar;             ///< The likeliest, of a body with sides.
  const RoadUsers* road_users = &kRoadUsersAnywhere;  ///< Of which it may be one; not the body's own.
  /// From which end of the length, and of the width, the centre was last measured: -1 the rear (the right side), +1 the front
  /// (the left side), 0 both; none before the first time.
  std::optional<int> length_held;
  std::optional<int> width_held;
};

/// What the scan saw next to the outermost echo of an object.
enum class Edge : std::uint8_t {
  kOpen,     ///< Something farther: the object ends here.
  kNoEcho,   ///< Nothing: it may end here, or go on without an echo.
  kHidden,   ///< Something nearer, or the end of the field of view.
};

/// A straight side of an object.
struct Side {
  double heading_rad = 0.0;  ///< Which way along it is not known.
  double length_m = 0.0;     ///< As far as it is seen.
  double off_m = 0.0;        ///< How far the echoes lie off the box's sides in the mean: what is round has any heading.
};

/// The echoes that belong to one object, in odom.
struct Observation {
  std::span<const Eigen::Vector2d> points_m;  ///< In the order of the beams; at least one.
  Eigen::Vector2d laser_m = Eigen::Vector2d::Zero();
  double beam_step_rad = 0.0;                 ///< Positive.
  Edge start = Edge::kOpen;                   ///< Before the first point
  Edge end = Edge::kOpen;                     ///< and after the last.
  std::optional<Side> side;                   ///< A long straight one, where one is seen.
  double unanswered_share = 0.0;              ///< Of the beams that met it: dark things answer now and then.
};

/// Where a glimpse puts the centre of a body, and what it tells of its size.
struct BodyMeasurement {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
  /// The centre's move when the body is redrawn at its new size with the sides that were seen held fast.
  Eigen::Vector2d recentring_m = Eigen::Vector2d::Zero();
  /// Of the step that the centre makes when it is measured from other ends than before: it is off by what the size is unsure
  /// by, in all scans alike, and no motion.
  Eigen::Matrix2d step_covariance_m2 = Eigen::Matrix2d::Zero();
  Body body;                                  ///< With the sizes as now believed.
};

/// Sides that look at the laser fix the body where it is seen; sides that do not follow from its remembered size. An end
/// that something nearer hides fixes nothing, but no body is smaller than what is seen of it.
BodyMeasurement measure_box(const Body& body, const Eigen::Vector2d& predicted_centre_m, const Observation& observation,
                            const TrackingConfig& config);

/// The centre alone of a box of just these sizes, whatever the echoes say of them.
Eigen::Vector2d box_centre_m(const Body& body, const Eigen::Vector2d& predicted_centre_m, const Observation& observation, const TrackingConfig& config);

/// Middle of the echoes, pushed behind the surface that they lie on by what half the object's depth may be.
BodyMeasurement measure_blob(const Body& body, const Observation& observation, const TrackingConfig& config);

/// Logarithm of the sum of two weights that are given by theirs.
double log_sum(double a, double b);

/// Log-likelihood of what was seen of a size, if such sizes are distributed like this. scale: of all sizes, against those of real road users.
double log_likelihood_of_size(double mean_m, double sigma_m, const SizeEvidence& evidence, double scale);

/// Sizes and kind as they follow from the body's evidence: a mixture over the kinds of road users, of which the likeliest
/// counts.
Body with_likely_sizes(Body body, const TrackingConfig& config);

/// What the scans said of both sizes.
struct EvidenceOfSizes {
  SizeEvidence length;
  SizeEvidence width;
};

/// The same, had the body the corners of a kind: what was seen from edge to edge goes on by what they are round.
struct EvidenceByKind {
  EvidenceOfSizes of_bicycle;
  EvidenceOfSizes of_vehicle;

  const EvidenceOfSizes& of(Kind kind) const { return kind == Kind::kBicycle ? of_bicycle : of_vehicle; }
};

EvidenceByKind evidence_by_kind(const Body& body, const TrackingConfig& config);

/// How deep the corners of a body are believed to be, if it is of this kind; bicycles, and what people carry, have none.
Size corner_of(const Body& body, Kind kind, const TrackingConfig& config);

/// Logarithm of how well the evidence of sizes fits the kinds of road users, to a constant.
double log_evidence_of_sizes(const Body& body, const TrackingConfig& config);

/// A box around something first seen now. box_heading_rad: of the longer visible side; which way the body points along it
/// is not known, and where only one short side is seen, that it is the width is only likely. The body refers to the road users.
Body likely_box(double box_heading_rad, const Observation& observation, const TrackingConfig& config, const RoadUsers& road_users = kRoadUsersAnywhere);

/// The body pointing the other way: its front is its rear.
Body turned_about(Body body);

/// Whether anything on the road has such a shape; what has not is made of echoes from several things.
bool is_plausible(const Body& body, const TrackingConfig& config);

/// Where the body's centre is if a glimpse is the first that is known of where it is.
Eigen::Vector2d supposed_centre_m(const Body& body, const Observation& observation);

/// The body turned by a quarter: what was held to be its length is its width.
Body turned_by_a_quarter(Body body, double sense, const TrackingConfig& config);

/// Largest distance between the points' bounding directions: a quick upper bound of what they span.
double extent_of(std::span<const Eigen::Vector2d> points_m);

/// Vector from the box (zero inside, margins included) to the point.
Eigen::Vector2d offset_from_box(const Body& body, const Eigen::Vector2d& centre_m, double margin_m, const Eigen::Vector2d& point_m);

/// Whether the offset is zero; sooner told of what is far away.
bool is_in_box(const Body& body, const Eigen::Vector2d& centre_m, double margin_m, const Eigen::Vector2d& point_m);

}  // namespace slammot::tracking
