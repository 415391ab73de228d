#include "services/detection/detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "common/geometry/full_turn.hpp"
#include "common/sensing/box_fit.hpp"
#include "services/detection/beam_directions.hpp"
#include "services/detection/ground.hpp"

namespace slammot::detection {
namespace {

using flow::EndCell;
using flow::LocalizedBeam;
using flow::LocalizedScan;
using flow::PointLabel;
using flow::Segment;
using flow::SegmentedScan;
using geometry::Matrix2;
using geometry::Vector2;
using sensing::BeamSpan;

PointLabel label_of(const LocalizedBeam& beam, const DetectionConfig& config) {
  switch (beam.end_cell) {
    case EndCell::kNoEcho: return PointLabel::kNoEcho;
    case EndCell::kOccupied: return PointLabel::kStationary;
    case EndCell::kFree:
      return beam.free_evidence >= config.least_free_log_odds ? PointLabel::kMoving
                                                              : PointLabel::kUnknown;
    case EndCell::kUnseen: break;
  }
  return PointLabel::kUnknown;
}

/// End points that the map predicts for the beams, in base. Beams for which it predicts none have
/// no end point.
class ExpectedOutline {
 public:
  ExpectedOutline(const LocalizedScan& scan, const BeamDirections& directions)
      : scan_(scan), directions_(directions) {}

  /// True if the echo lies near the polyline through the end points of neighbouring beams. At
  /// grazing incidence an echo of a wall is far from its own beam's end point but near the wall's
  /// line.
  bool contains(std::size_t beam, const DetectionConfig& config) const {
    const LocalizedBeam& echo = scan_.beams[beam];
    const double within_m = config.outline_tolerance_m +
                            config.outline_tolerance_per_m * static_cast<double>(echo.range_m);
    const Vector2 point = echo.point_in_base_m.cast<double>();
    const std::size_t first = beam < flow::kExpectedAside ? 0 : beam - flow::kExpectedAside;
    const std::size_t last = std::min(beam + flow::kExpectedAside + 1, scan_.beams.size());
    for (std::size_t i = first; i < last; ++i) {
      if (!has_end(i)) continue;
      const Vector2 end = end_of(i);
      if ((point - end).squaredNorm() < within_m * within_m) return true;
      if (i + 1 == last || !has_end(i + 1)) continue;
      const Vector2 way = end_of(i + 1) - end;
      const double length2 = way.squaredNorm();
      if (length2 > kMaxFaceM * kMaxFaceM) continue;
      const double share = std::clamp(way.dot(point - end) / std::max(length2, 1e-9), 0.0, 1.0);
      if ((point - end - share * way).squaredNorm() < within_m * within_m) return true;
    }
    return false;
  }

 private:
  static constexpr double kMaxFaceM = 6.0;  ///< Longest face between end points of neighbouring
                                            ///< beams; a greater distance is a gap between objects.
  bool has_end(std::size_t beam) const {
    return static_cast<double>(scan_.beams[beam].expected_range_m) < scan_.max_range_m - 0.5;
  }
  Vector2 end_of(std::size_t beam) const {
    return scan_.base_from_laser.translation_m() +
           static_cast<double>(scan_.beams[beam].expected_range_m) * directions_[beam];
  }
  const LocalizedScan& scan_;
  const BeamDirections& directions_;
};

/// Copies the header of the scan; the other fields of `segmented` stay.
SegmentedScan with_header_of(const LocalizedScan& scan, SegmentedScan segmented) {
  segmented.stamp_ns = scan.stamp_ns;
  segmented.sequence = scan.sequence;
  segmented.scanner_id = scan.scanner_id;
  segmented.base_from_laser = scan.base_from_laser;
  segmented.max_range_m = scan.max_range_m;
  segmented.beam_step_rad = scan.beam_step_rad;
  segmented.sweep_s = scan.sweep_s;
  segmented.odom_from_base = scan.odom_from_base;
  // Motion is judged relative to the local map.
  segmented.odom_from_base.covariance *= scan.local_variance_share;
  segmented.map_from_odom = scan.map_from_odom;
  segmented.map_id = scan.map_id;
  segmented.odom_id = scan.odom_id;
  return segmented;
}

void label_points(const LocalizedScan& scan, const BeamDirections& directions,
                  const DetectionConfig& config, SegmentedScan& segmented) {
  segmented.points_in_base_m.resize(scan.beams.size());
  segmented.range_m.resize(scan.beams.size());
  segmented.labels.resize(scan.beams.size());
  const ExpectedOutline outline(scan, directions);
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    segmented.points_in_base_m[i] = scan.beams[i].point_in_base_m;
    segmented.range_m[i] = scan.beams[i].range_m;
    segmented.labels[i] = label_of(scan.beams[i], config);
    if (segmented.labels[i] == PointLabel::kMoving && outline.contains(i, config))
      segmented.labels[i] = PointLabel::kStationary;
  }
}

void merge_with_equal_neighbours(std::vector<Run>& runs) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (runs[i].is_moving == runs[kept].is_moving) runs[kept].count += runs[i].count;
    else runs[++kept] = runs[i];
  }
  if (!runs.empty()) runs.resize(kept + 1);
}

bool lies_on_line(const Eigen::Vector2f& from, const Eigen::Vector2f& to,
                  const Eigen::Vector2f& point, double within_m) {
  const Eigen::Vector2f way = to - from;
  const Eigen::Vector2f off = point - from;
  return std::abs(way.x() * off.y() - way.y() * off.x()) <=
         static_cast<float>(within_m) * way.norm();
}

/// True if the moving run continues the line of the stationary runs beside it: a wall whose cells
/// the map does not know completely.
bool continues_wall(std::size_t index, const std::vector<Run>& runs,
                    std::span<const std::uint16_t> beams, const SegmentedScan& scan,
                    const DetectionConfig& config) {
  constexpr std::size_t kBack = 4;
  const auto point = [&](std::size_t i) { return scan.points_in_base_m[beams[i]]; };
  const Run& run = runs[index];
  const std::size_t end = run.first + run.count;
  const bool has_before = index > 0;
  const bool has_after = index + 1 < runs.size();
  if ((!has_before && !has_after) ||
      (has_before != has_after && runs[has_before ? index - 1 : index + 1].count < 3))
    return false;
  const std::size_t from =
      has_before ? run.first - (has_after ? 1 : std::min(kBack, runs[index - 1].count))
                 : end + std::min(kBack, runs[index + 1].count) - 1;
  const std::size_t to = has_after ? end : run.first - 1;
  for (std::size_t i = run.first; i < end; ++i)
    if (!lies_on_line(point(from), point(to), point(i), config.outline_tolerance_m)) return false;
  return true;
}

/// Splits beams into moving and stationary runs. A beam with unknown label joins the run before it.
/// Runs too short for an object take the label of their neighbours.
void split_by_label(std::span<const std::uint16_t> beams, const SegmentedScan& scan,
                    const DetectionConfig& config, std::vector<Run>& runs) {
  runs.clear();
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const PointLabel label = scan.labels[beams[i]];
    if (label == PointLabel::kUnknown && runs.empty()) {
      ++unknown;
      continue;
    }
    const bool is_moving =
        label == PointLabel::kUnknown ? runs.back().is_moving : label == PointLabel::kMoving;
    if (runs.empty()) runs.push_back({0, unknown + 1, is_moving});
    else if (runs.back().is_moving == is_moving) ++runs.back().count;
    else runs.push_back({i, 1, is_moving});
  }
  if (runs.empty()) runs.push_back({0, beams.size(), false});
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].is_moving && continues_wall(i, runs, beams, scan, config))
      runs[i].is_moving = false;
  merge_with_equal_neighbours(runs);
  for (int pass = 0; pass < 2 && runs.size() > 1; ++pass) {
    for (Run& run : runs) {
      const int least = run.is_moving ? config.least_moving_run : config.least_stationary_run;
      if (static_cast<int>(run.count) < least) run.is_moving = !run.is_moving;
    }
    merge_with_equal_neighbours(runs);
  }
}

double moving_share(const Segment& segment, const SegmentedScan& scan) {
  int moving = 0;
  int decidable = 0;
  for (const std::uint16_t beam : segment.beams) {
    moving += scan.labels[beam] == PointLabel::kMoving ? 1 : 0;
    decidable += scan.labels[beam] == PointLabel::kUnknown ? 0 : 1;
  }
  return decidable == 0 ? 0.0 : static_cast<double>(moving) / decidable;
}

double mean_moving_evidence(const Segment& segment, const LocalizedScan& scan) {
  double sum = 0.0;
  for (const std::uint16_t beam : segment.beams)
    sum += static_cast<double>(scan.beams[beam].moving_evidence);
  return sum / static_cast<double>(segment.beams.size());
}

PointLabel label_of_segment(const Segment& segment, const LocalizedScan& localized,
                            const SegmentedScan& scan, const DetectionConfig& config) {
  if (segment.moving_share > config.moving_share) return PointLabel::kMoving;
  const bool is_stationary =
      std::any_of(segment.beams.begin(), segment.beams.end(),
                  [&](std::uint16_t beam) { return scan.labels[beam] == PointLabel::kStationary; });
  if (is_stationary) return PointLabel::kStationary;
  const bool has_moving_evidence =
      static_cast<int>(segment.beams.size()) <= config.largest_by_moving_evidence &&
      mean_moving_evidence(segment, localized) >= config.least_moving_evidence;
  return has_moving_evidence ? PointLabel::kMoving : PointLabel::kUnknown;
}

/// True if the nearest echo within two beams in direction `step` (+1 or -1) is clearly nearer than
/// the beam's echo, or if the field of view ends there.
bool is_occluded_beyond(std::uint16_t beam, int step, const SegmentedScan& scan,
                        const DetectionConfig& config) {
  constexpr int kBeamsLookedAt = 2;
  for (int i = 1; i <= kBeamsLookedAt; ++i) {
    const int count = static_cast<int>(scan.range_m.size());
    int neighbour = static_cast<int>(beam) + i * step;
    if (geometry::goes_all_round(scan.range_m.size(), scan.beam_step_rad))
      neighbour = (neighbour + count) % count;
    if (neighbour < 0 || neighbour >= count) return true;  // end of the field of view
    const double range_m = static_cast<double>(scan.range_m[static_cast<std::size_t>(neighbour)]);
    if (range_m > 0.0)
      return range_m < static_cast<double>(scan.range_m[beam]) - config.occluder_margin_m;
  }
  return false;
}

void add_echoes(const BeamSpan& span, const std::vector<float>& range_m,
                std::vector<std::uint16_t>& beams) {
  for (std::uint16_t beam = span.first; beam <= span.last; ++beam)
    if (range_m[beam] > 0.0F) beams.push_back(beam);
}

/// Measurement covariance of one echo in odom [m²], without that of the vehicle's pose.
Matrix2 echo_covariance(const Vector2& way_m, double beam_step_rad, const DetectionConfig& config) {
  const double range_m = std::max(way_m.norm(), 1e-3);
  const Vector2 along = way_m / range_m;
  const double sigma_along_m = config.range_noise_m + config.range_noise_per_m * range_m;
  // Uniformly distributed over the beam's width.
  const double sigma_across_m = range_m * std::abs(beam_step_rad) / std::sqrt(12.0);
  return sigma_along_m * sigma_along_m * along * along.transpose() +
         sigma_across_m * sigma_across_m * (Matrix2::Identity() - along * along.transpose());
}

/// Contribution of the pose's covariance to a point at `lever_in_odom_m` from the vehicle; Wang
/// 2004, Eq. (2.3).
Matrix2 pose_contribution(const geometry::UncertainPose2& odom_from_base,
                          const Vector2& lever_in_odom_m) {
  const geometry::Matrix3 J = geometry::compound_jacobian_first(lever_in_odom_m);
  return (J * odom_from_base.covariance * J.transpose()).topLeftCorner<2, 2>();
}

void describe_shape(Segment& segment, const SegmentedScan& scan, const Matrix2& R,
                    const DetectionConfig& config, std::vector<Vector2>& points_in_odom_m) {
  points_in_odom_m.clear();
  const Vector2 t = scan.odom_from_base.pose.translation_m();
  Vector2 sum = Vector2::Zero();
  for (const std::uint16_t beam : segment.beams) {
    points_in_odom_m.push_back(R * scan.points_in_base_m[beam].cast<double>() + t);
    sum += points_in_odom_m.back();
  }
  const auto count = static_cast<double>(segment.beams.size());
  segment.centroid_in_odom_m = sum / count;
  const Vector2 laser_in_odom_m = R * scan.base_from_laser.translation_m() + t;
  const Vector2 centroid_in_base_m = R.transpose() * (segment.centroid_in_odom_m - t);
  segment.centroid_covariance_m2 =
      echo_covariance(segment.centroid_in_odom_m - laser_in_odom_m, scan.beam_step_rad, config) /
          count +
      pose_contribution(scan.odom_from_base, R * centroid_in_base_m);
  // Only segments that may initiate a track need the heading of the best fit. For the others the
  // line between the end points suffices.
  const Vector2 way = points_in_odom_m.back() - points_in_odom_m.front();
  const sensing::OrientedBox box =
      segment.label == PointLabel::kMoving
          ? sensing::fit_box(points_in_odom_m, config.range_noise_m)
          : sensing::box_at_heading(points_in_odom_m, std::atan2(way.y(), way.x()));
  segment.box_centre_in_odom_m = box.centre_m;
  segment.box_heading_rad = box.heading_rad;
  segment.box_length_m = box.length_m;
  segment.box_width_m = box.width_m;
}

void finish_segment(Segment& segment, const LocalizedScan& localized, const DetectionConfig& config,
                    const SegmentedScan& scan, const Matrix2& odom_from_base_turn,
                    std::vector<Vector2>& points_in_odom_m) {
  segment.moving_share = moving_share(segment, scan);
  segment.label = label_of_segment(segment, localized, scan, config);
  segment.occluded_at_start = is_occluded_beyond(segment.beams.front(), -1, scan, config);
  segment.occluded_at_end = is_occluded_beyond(segment.beams.back(), +1, scan, config);
  describe_shape(segment, scan, odom_from_base_turn, config, points_in_odom_m);
  if (segment.label == PointLabel::kMoving && segment.box_length_m > config.longest_mover_m)
    segment.label = PointLabel::kUnknown;
}

}  // namespace

SegmentedScan Detector::detect(const LocalizedScan& localized, SegmentedScan recycled) {
  SegmentedScan scan = with_header_of(localized, std::move(recycled));
  directions_.compute(localized);
  label_points(localized, directions_, config_, scan);
  remove_ground(scan);
  create_segments(localized, scan);
  finish_segments(localized, scan);
  return scan;
}

void Detector::remove_ground(SegmentedScan& scan) {
  find_ground(scan, directions_, config_, is_ground_);
  range_without_ground_m_ = scan.range_m;
  for (std::size_t i = 0; i < is_ground_.size(); ++i) {
    if (!is_ground_[i]) continue;
    scan.labels[i] = PointLabel::kNoEcho;
    range_without_ground_m_[i] = 0.0F;
  }
}

/// Creates segments and assigns their beams.
void Detector::create_segments(const LocalizedScan& localized, SegmentedScan& scan) {
  sensing::segment_by_distance(scan.points_in_base_m, range_without_ground_m_,
                               localized.beam_step_rad, config_.segmentation, spans_);
  const bool first_span_continues_last =
      sensing::goes_on_across_seam(scan.points_in_base_m, range_without_ground_m_,
                                   localized.beam_step_rad, config_.segmentation, spans_);
  std::size_t count = 0;
  for (std::size_t i = first_span_continues_last ? 1 : 0; i < spans_.size(); ++i) {
    beams_.clear();
    add_echoes(spans_[i], range_without_ground_m_, beams_);
    if (first_span_continues_last && i + 1 == spans_.size())
      add_echoes(spans_.front(), range_without_ground_m_, beams_);
    split_by_label(beams_, scan, config_, runs_);
    for (const Run& run : runs_) {
      if (count == scan.segments.size()) spare_segments_.resize(scan.segments, count + 1);
      std::vector<std::uint16_t>& beams = scan.segments[count++].beams;
      if (!beams.empty() && beams.capacity() < run.count)
        beams.reserve(scan.range_m.size());  // once for all later scans
      const auto first = beams_.begin() + static_cast<std::ptrdiff_t>(run.first);
      beams.assign(first, first + static_cast<std::ptrdiff_t>(run.count));
    }
  }
  spare_segments_.resize(scan.segments, count);
}

void Detector::finish_segments(const LocalizedScan& localized, SegmentedScan& scan) {
  const Matrix2 odom_from_base_turn = geometry::rotation(localized.odom_from_base.pose.heading_rad);
  const std::size_t count = scan.segments.size();
  work::share(help_, kRanges, [&](std::size_t range) {
    for (std::size_t i = count * range / kRanges; i < count * (range + 1) / kRanges; ++i) {
      scan.segments[i].segment_id = static_cast<std::uint32_t>(i);
      finish_segment(scan.segments[i], localized, config_, scan, odom_from_base_turn,
                     points_in_odom_m_[range]);
    }
  });
}

SegmentedScan detect(const LocalizedScan& scan, const DetectionConfig& config) {
  return Detector(config).detect(scan);
}

}  // namespace slammot::detection
