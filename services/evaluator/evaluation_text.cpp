#include "services/evaluator/evaluation_text.hpp"

#include <numbers>

#include "common/files/text.hpp"

namespace slammot::evaluator {
namespace {

using files::text;

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string error_row(const char* name, const metrics::ErrorSummary& errors, const char* unit,
                      double scale = 1.0) {
  if (errors.count == 0) return {};
  return text("  %-34s %9.3f %9.3f %9.3f %9.3f  %s\n", name, errors.rmse * scale,
              errors.mean * scale, errors.median * scale, errors.max * scale, unit);
}

std::string describe(const char* title, const TrajectoryEvaluation& trajectory) {
  if (trajectory.poses == 0) return {};
  std::string lines =
      text("%s: %zu of %zu poses have a true pose\n  %-34s %9s %9s %9s %9s\n", title,
           trajectory.pairs, trajectory.poses, "", "rmse", "mean", "median", "max");
  lines += error_row("ATE, rigidly aligned", trajectory.absolute_m, "m");
  lines += error_row("ATE, first pose aligned", trajectory.absolute_from_start_m, "m");
  for (const RelativeErrors& relative : trajectory.relative) {
    lines += error_row(text("RPE over %g m, consecutive", relative.delta_m).c_str(),
                       relative.consecutive_m, "m");
    lines += error_row(text("drift over %g m, all pairs", relative.delta_m).c_str(),
                       relative.drift_m, "m");
    lines += error_row(text("heading drift over %g m", relative.delta_m).c_str(),
                       relative.drift_rad, "deg", kDegrees);
  }
  return lines;
}

std::string describe_nees(const char* name, const metrics::NeesSummary& nees) {
  if (nees.samples == 0) return {};
  return text("%s: NEES %.3f over %zu samples, 95 %% band %.3f to %.3f: %s\n", name, nees.mean,
              nees.samples, nees.band_low, nees.band_high, nees.is_inside() ? "inside" : "outside");
}

std::string object_row(const std::string& name, const metrics::ObjectErrors& errors) {
  return text("  %-12s %7zu %7.3f %9.3f %9.3f %9.3f %9.1f %9.2f %9.2f %9.2f\n", name.c_str(),
              errors.rows, errors.recall, errors.centre_m.median, errors.velocity_mps.median,
              errors.velocity_mps.rmse, errors.heading_rad.median * kDegrees,
              errors.length_m.median, errors.width_m.median, errors.position_nees.mean);
}

std::string describe_classes(const std::map<std::string, metrics::ObjectErrors>& by_class) {
  std::string lines = text("  %-12s %12s   %s\n", "class", "right [%]", "rows reported as");
  for (const auto& [name, errors] : by_class) {
    lines += text("  %-12s %12.1f  ", name.c_str(), 100.0 * errors.right_class);
    for (const auto& [reported, rows] : errors.reported_as)
      lines += text(" %s %zu", reported.c_str(), rows);
    lines += "\n";
  }
  return lines;
}

std::string describe(const std::vector<metrics::PredictionErrors>& predictions) {
  if (predictions.empty()) return {};
  std::string lines = text("  %-12s %9s %9s %9s %9s %14s %16s\n", "predicted", "rms [m]", "med [m]",
                           "p95 [m]", "NEES", "95 % band", "in 95 % ellipse");
  for (const metrics::PredictionErrors& errors : predictions) {
    lines += text("  %-12s %9.2f %9.2f %9.2f %9.2f %6.2f to %4.2f %16.3f\n",
                  text("%g s ahead", errors.after_s).c_str(), errors.displacement_m.rmse,
                  errors.displacement_m.median, errors.displacement_m.p95, errors.nees.mean,
                  errors.nees.band_low, errors.nees.band_high, errors.inside_share);
  }
  return lines;
}

std::string describe_strictly(const TrackingEvaluation& tracking) {
  const metrics::BoxErrors& boxes = tracking.vehicle_boxes.all;
  std::string lines =
      text("  strict: HOTA %.3f   stopped objects that had moved: covered in %zu of %zu rows\n",
           tracking.strict_hota.hota, tracking.stopped.covered_rows, tracking.stopped.rows) +
      text(
          "  boxes of vehicles from 2 s on, %zu rows: IoU median %.3f, lowest tenth %.3f   95 "
          "%% "
          "within: centre %.2f m, heading %.1f deg   velocity rmse %.2f m/s\n",
          boxes.rows, boxes.iou_median, boxes.iou_lowest_tenth, boxes.centre_m.p95,
          boxes.heading_rad.p95 * kDegrees, boxes.velocity_mps.rmse);
  for (std::size_t band = 0; band < metrics::kOutlineBands.size(); ++band) {
    const metrics::BoxErrors& errors = tracking.vehicle_boxes.by_outline[band];
    if (errors.rows == 0 || errors.rows == boxes.rows) continue;  // all: no echoes were given
    lines += text(
        "    outline seen from %3.0f %%: %6zu rows, IoU median %.3f, lowest tenth %.3f   95 %% "
        "within: centre %.2f m, heading %.1f deg\n",
        100.0 * metrics::kOutlineBands[band], errors.rows, errors.iou_median,
        errors.iou_lowest_tenth, errors.centre_m.p95, errors.heading_rad.p95 * kDegrees);
  }
  return lines;
}

std::string describe(const TrackingEvaluation& tracking) {
  const metrics::ClearMot& clear = tracking.clear;
  std::string lines = text("tracking: %zu objects and %zu tracks that count, in %zu scans\n",
                           tracking.objects, tracking.tracks, tracking.scans);
  lines += text(
      "  HOTA %.3f (detection %.3f, association %.3f, localization %.3f)   MOTA %.3f   MOTP %.3f   "
      "IDF1 %.3f\n",
      tracking.hota.hota, tracking.hota.detection_accuracy, tracking.hota.association_accuracy,
      tracking.hota.localization_accuracy, clear.mota, clear.motp, tracking.identity.f1);
  lines += text(
      "  recall %.3f   precision %.3f   rows: %zu right, %zu false, %zu missed   switches %zu   "
      "fragmentations %zu\n",
      clear.recall, clear.precision, clear.true_positives, clear.false_positives, clear.misses,
      clear.switches, clear.fragmentations);
  lines += text(
      "  objects tracked over 80 %% of the time %zu, under 20 %% %zu, never detected %zu   "
      "detection delay median %.2f s, 95 %% within %.2f s\n",
      clear.mostly_tracked, clear.mostly_lost, tracking.errors.never_detected,
      tracking.errors.detection_delay_s.median, tracking.errors.detection_delay_s.p95);
  lines += text("  GOSPA %.3f m   of %.2f m2 localization, %.2f m2 missed, %.2f m2 false\n",
                tracking.gospa.distance_m, tracking.gospa.localization_m2, tracking.gospa.missed_m2,
                tracking.gospa.false_tracks_m2);
  lines += "  " + describe_nees("position of tracks", tracking.errors.all.position_nees);
  lines += text("  %-12s %7s %7s %9s %9s %9s %9s %9s %9s %9s\n", "", "rows", "recall", "centre",
                "velocity", "velocity", "heading", "length", "width", "NEES");
  lines += text("  %-12s %7s %7s %9s %9s %9s %9s %9s %9s %9s\n", "", "", "", "med [m]", "med [m/s]",
                "rms [m/s]", "med [deg]", "med [m]", "med [m]", "(2 dof)");
  lines += object_row("all", tracking.errors.all);
  for (const auto& [name, errors] : tracking.errors.by_class) lines += object_row(name, errors);
  for (const metrics::DistanceBand& band : tracking.errors.by_distance)
    lines += object_row(text("%g-%g m", band.from_m, band.to_m), band.errors);
  return lines + describe_classes(tracking.errors.by_class) + describe(tracking.predictions) +
         describe_strictly(tracking);
}

std::string describe(const metrics::OcclusionFigures& occlusion) {
  std::string lines =
      text("occlusions\n  %-12s %14s %14s\n", "length", "identity kept", "covered [%]");
  for (const metrics::OcclusionBand& band : occlusion.by_length)
    lines +=
        text("  %-12s %14s %14.1f\n", text("%g-%g s", band.from_s, band.to_s).c_str(),
             text("%zu of %zu", band.kept, band.occlusions).c_str(), 100.0 * band.covered_share());
  lines += describe_nees("  position while hidden", occlusion.position_nees);
  lines += text("  position while hidden: rmse %.2f m over %zu rows, %.3f in the 95 %% ellipse\n",
                occlusion.position_m.rmse, occlusion.position_m.count, occlusion.inside_share);
  lines +=
      text("  rows of occluded tracks: %zu at their object, %zu at another, %zu at none\n",
           occlusion.published.occluded.at_own_object, occlusion.published.occluded.at_other_object,
           occlusion.published.occluded.at_nothing);
  return lines + text(
                     "  gaps in what is published of tracks: %zu, %zu of them on one object, %zu "
                     "with it in view\n",
                     occlusion.published.gaps.gaps, occlusion.published.gaps.gaps_on_object,
                     occlusion.published.gaps.gaps_in_view);
}

std::string describe(const OtherCarEvaluation& car) {
  std::string lines = text(
      "other car: matched in %zu of %zu scans, by %zu tracks; %.3f false moving tracks a scan\n  "
      "%-34s %9s %9s %9s %9s\n",
      car.matched_scans, car.scans, car.identities, car.false_moving_tracks_a_scan, "", "rmse",
      "mean", "median", "max");
  lines += error_row("position", car.position_m, "m");
  return lines + error_row("velocity", car.velocity_mps, "m/s");
}

std::string label_row(const char* name, const metrics::DetectionCounts& counts) {
  return text("  %-14s %9.3f %9.3f %11.4f %11.4f %9.3f %9.3f\n", name, counts.moving_precision(),
              counts.moving_recall(), counts.stationary_precision(), counts.stationary_recall(),
              counts.segment_precision(), counts.segment_recall());
}

std::string describe(const DetectionEvaluation& detection) {
  std::string lines =
      text("labels of echoes in %zu scans\n  %-14s %9s %9s %11s %11s %9s %9s\n", detection.scans,
           "", "moving", "moving", "stationary", "stationary", "segment", "segment");
  lines += text("  %-14s %9s %9s %11s %11s %9s %9s\n", "", "precision", "recall", "precision",
                "recall", "precision", "recall");
  return lines + label_row("by detection", detection.by_detection) +
         label_row("by tracking", detection.by_tracking);
}

std::string describe(const metrics::MapQuality& map) {
  return text(
      "map: precision %.3f of %zu occupied cells, recall %.3f of the walls seen, residue of movers "
      "%.2f %%\n",
      map.precision(), map.occupied_cells, map.recall(), 100.0 * map.residue());
}

std::string describe(const WayEvaluation& ways) {
  std::string lines = text(
      "ways of movers, within 1 m and 20 deg   from confidence 0 / %.1f on\n  %-12s %12s %12s %17s "
      "%17s\n",
      ways.least_confidence, "kind", "in view [m]", "found [m]", "recall", "precision");
  for (std::size_t kind = 0; kind < ways.all.size(); ++kind) {
    const traffic::WayAccuracy& all = ways.all[kind];
    const traffic::WayAccuracy& confident = ways.confident[kind];
    lines += text("  %-12s %12.0f %12.0f %9.3f / %.3f %9.3f / %.3f\n",
                  name_of(static_cast<traffic::Mover>(kind)), all.travelled_m, all.length_m,
                  all.recall(), confident.recall(), all.precision(), confident.precision());
  }
  return lines;
}

std::string wall_row(const char* name, const metrics::MapSharpness& map) {
  return text("  %-34s %12.4f %12zu %12zu %14.0f\n", name, map.mean_entropy_bits(),
              map.touched_cells, map.occupied_cells, map.entropy_bits);
}

std::string describe(const WallSharpness& walls, double cell_size_m) {
  std::string lines = text(
      "sharpness of maps with cells of %g m from the same %zu scans\n  %-34s %12s %12s %12s %14s\n",
      cell_size_m, walls.scans, "", "bits a cell", "cells met", "occupied", "bits in all");
  return lines + wall_row("by the result's poses", walls.of_estimate) +
         wall_row("by the true poses", walls.of_truth);
}

}  // namespace

std::string to_text(const Evaluation& evaluation, const EvaluationOptions& options) {
  std::string lines = describe("trajectory after the last correction", evaluation.corrected);
  lines += describe("trajectory as published live", evaluation.online);
  if (evaluation.without_loops)
    lines += describe("trajectory without loops (frame odom)", *evaluation.without_loops);
  if (evaluation.relative_pose_nees)
    lines += describe_nees("relative poses over 1 s", *evaluation.relative_pose_nees);
  if (evaluation.detection) lines += describe(*evaluation.detection);
  if (evaluation.tracking) {
    lines += text(
        "objects within %g m, at least %g m/s and %d echoes; a match is within %g m of the true "
        "box\n",
        options.rule.range_m, options.rule.least_speed_mps, options.rule.least_points,
        options.rule.gate_m);
    lines += describe(*evaluation.tracking);
  }
  if (evaluation.occlusion) lines += describe(*evaluation.occlusion);
  if (evaluation.other_car) lines += describe(*evaluation.other_car);
  if (evaluation.ways) lines += describe(*evaluation.ways);
  if (evaluation.map) lines += describe(*evaluation.map);
  if (evaluation.walls) lines += describe(*evaluation.walls, options.walls.cell_size_m);
  for (const std::string& note : evaluation.notes) lines += "note: " + note + "\n";
  return lines;
}

}  // namespace slammot::evaluator
