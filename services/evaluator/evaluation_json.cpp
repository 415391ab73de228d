#include <cmath>

#include <nlohmann/json.hpp>

#include "services/evaluator/evaluation_text.hpp"

namespace slammot::evaluator {
namespace {

using Json = nlohmann::ordered_json;

/// Rounds to six decimals. Replaces -0 and non-finite values, which would differ between machines.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  const double rounded = std::round(value * 1e6) / 1e6;
  return rounded == 0.0 ? 0.0 : rounded;
}

Json to_json(const metrics::ErrorSummary& errors) {
  if (errors.count == 0) return nullptr;
  return {{"count", errors.count},       {"rmse", number(errors.rmse)},
          {"mean", number(errors.mean)}, {"median", number(errors.median)},
          {"p95", number(errors.p95)},   {"max", number(errors.max)}};
}

Json to_json(const metrics::NeesSummary& nees) {
  if (nees.samples == 0) return nullptr;
  return {{"samples", nees.samples},
          {"degrees_of_freedom", nees.degrees_of_freedom},
          {"mean", number(nees.mean)},
          {"band_low", number(nees.band_low)},
          {"band_high", number(nees.band_high)},
          {"is_inside", nees.is_inside()}};
}

Json to_json(const TrajectoryEvaluation& trajectory) {
  Json relative = Json::object();
  for (const RelativeErrors& errors : trajectory.relative) {
    const std::string name = std::to_string(static_cast<int>(errors.delta_m)) + "_m";
    relative[name] = {{"rpe_m", to_json(errors.consecutive_m)},
                      {"drift_m", to_json(errors.drift_m)},
                      {"drift_rad", to_json(errors.drift_rad)}};
  }
  return {{"poses", trajectory.poses},
          {"pairs", trajectory.pairs},
          {"ate_m", to_json(trajectory.absolute_m)},
          {"ate_first_pose_aligned_m", to_json(trajectory.absolute_from_start_m)},
          {"over", relative}};
}

Json to_json(const metrics::ObjectErrors& errors) {
  return {{"rows", errors.rows},
          {"matched_rows", errors.matched_rows},
          {"recall", number(errors.recall)},
          {"right_class", number(errors.right_class)},
          {"reported_as", errors.reported_as},
          {"centre_m", to_json(errors.centre_m)},
          {"velocity_mps", to_json(errors.velocity_mps)},
          {"heading_rad", to_json(errors.heading_rad)},
          {"length_m", to_json(errors.length_m)},
          {"width_m", to_json(errors.width_m)},
          {"position_nees", to_json(errors.position_nees)}};
}

Json to_json(const metrics::ClearMot& clear) {
  return {{"mota", number(clear.mota)},
          {"motp", number(clear.motp)},
          {"recall", number(clear.recall)},
          {"precision", number(clear.precision)},
          {"true_positives", clear.true_positives},
          {"false_positives", clear.false_positives},
          {"misses", clear.misses},
          {"switches", clear.switches},
          {"fragmentations", clear.fragmentations},
          {"mostly_tracked", clear.mostly_tracked},
          {"mostly_lost", clear.mostly_lost}};
}

Json to_json(const metrics::Hota& hota) {
  return {{"hota", number(hota.hota)},
          {"detection_accuracy", number(hota.detection_accuracy)},
          {"association_accuracy", number(hota.association_accuracy)},
          {"detection_recall", number(hota.detection_recall)},
          {"detection_precision", number(hota.detection_precision)},
          {"localization_accuracy", number(hota.localization_accuracy)}};
}

Json to_json(const std::vector<metrics::PredictionErrors>& predictions) {
  Json rows = Json::array();
  for (const metrics::PredictionErrors& errors : predictions)
    rows.push_back({{"after_s", errors.after_s},
                    {"displacement_m", to_json(errors.displacement_m)},
                    {"nees", to_json(errors.nees)},
                    {"inside_share", number(errors.inside_share)}});
  return rows;
}

Json to_json(const metrics::BoxErrors& errors) {
  if (errors.rows == 0) return nullptr;
  return {{"rows", errors.rows},
          {"iou_median", number(errors.iou_median)},
          {"iou_lowest_tenth", number(errors.iou_lowest_tenth)},
          {"centre_m", to_json(errors.centre_m)},
          {"heading_rad", to_json(errors.heading_rad)},
          {"velocity_mps", to_json(errors.velocity_mps)}};
}

Json to_json(const metrics::VehicleBoxErrors& errors) {
  Json figures = to_json(errors.all);
  if (figures.is_null()) return figures;
  for (std::size_t band = 0; band < errors.by_outline.size(); ++band) {
    if (errors.by_outline[band].rows == 0) continue;
    Json row = to_json(errors.by_outline[band]);
    row["outline_seen_from"] = number(metrics::kOutlineBands[band]);
    figures["by_outline_seen"].push_back(row);
  }
  return figures;
}

Json to_json(const TrackingEvaluation& tracking) {
  Json classes = Json::object();
  for (const auto& [name, errors] : tracking.errors.by_class) classes[name] = to_json(errors);
  Json bands = Json::array();
  for (const metrics::DistanceBand& band : tracking.errors.by_distance) {
    Json row = {{"from_m", band.from_m}, {"to_m", band.to_m}, {"false_rows", band.false_rows}};
    row.update(to_json(band.errors));
    bands.push_back(row);
  }
  return {{"scans", tracking.scans},
          {"objects", tracking.objects},
          {"tracks", tracking.tracks},
          {"hota", to_json(tracking.hota)},
          {"clear_mot", to_json(tracking.clear)},
          {"identity",
           {{"f1", number(tracking.identity.f1)},
            {"precision", number(tracking.identity.precision)},
            {"recall", number(tracking.identity.recall)}}},
          {"gospa",
           {{"distance_m", number(tracking.gospa.distance_m)},
            {"localization_m2", number(tracking.gospa.localization_m2)},
            {"missed_m2", number(tracking.gospa.missed_m2)},
            {"false_tracks_m2", number(tracking.gospa.false_tracks_m2)}}},
          {"detection_delay_s", to_json(tracking.errors.detection_delay_s)},
          {"never_detected", tracking.errors.never_detected},
          {"all", to_json(tracking.errors.all)},
          {"by_class", classes},
          {"by_distance", bands},
          {"predictions", to_json(tracking.predictions)},
          {"strict_hota", to_json(tracking.strict_hota)},
          {"vehicle_boxes", to_json(tracking.vehicle_boxes)},
          {"stopped",
           {{"rows", tracking.stopped.rows}, {"covered_rows", tracking.stopped.covered_rows}}}};
}

Json to_json(const metrics::OcclusionFigures& occlusion) {
  Json bands = Json::array();
  for (const metrics::OcclusionBand& band : occlusion.by_length)
    bands.push_back({{"from_s", number(band.from_s)},
                     {"to_s", number(band.to_s)},
                     {"occlusions", band.occlusions},
                     {"identity_kept", band.kept},
                     {"hidden_rows", band.hidden_rows},
                     {"covered_rows", band.covered_rows}});
  return {{"by_length", bands},
          {"position_m", to_json(occlusion.position_m)},
          {"position_nees", to_json(occlusion.position_nees)},
          {"inside_share", number(occlusion.inside_share)},
          {"occluded_rows",
           {{"at_own_object", occlusion.published.occluded.at_own_object},
            {"at_other_object", occlusion.published.occluded.at_other_object},
            {"at_nothing", occlusion.published.occluded.at_nothing},
            {"precision", number(occlusion.published.occluded.precision())}}},
          {"published_gaps",
           {{"gaps", occlusion.published.gaps.gaps},
            {"missing_rows", occlusion.published.gaps.missing_rows},
            {"gaps_on_object", occlusion.published.gaps.gaps_on_object},
            {"gaps_in_view", occlusion.published.gaps.gaps_in_view},
            {"missing_rows_in_view", occlusion.published.gaps.missing_rows_in_view}}}};
}

Json to_json(const OtherCarEvaluation& car) {
  return {{"scans", car.scans},
          {"matched_scans", car.matched_scans},
          {"identities", car.identities},
          {"position_m", to_json(car.position_m)},
          {"velocity_mps", to_json(car.velocity_mps)},
          {"false_moving_tracks_a_scan", number(car.false_moving_tracks_a_scan)}};
}

Json to_json(const metrics::DetectionCounts& counts) {
  return {{"moving_precision", number(counts.moving_precision())},
          {"moving_recall", number(counts.moving_recall())},
          {"stationary_precision", number(counts.stationary_precision())},
          {"stationary_recall", number(counts.stationary_recall())},
          {"segment_precision", number(counts.segment_precision())},
          {"segment_recall", number(counts.segment_recall())},
          {"moving_points",
           counts.moving_as_moving + counts.moving_as_stationary + counts.moving_as_unknown},
          {"stationary_points", counts.stationary_as_moving + counts.stationary_as_stationary +
                                    counts.stationary_as_unknown},
          {"moving_points_unknown", counts.moving_as_unknown},
          {"stationary_points_unknown", counts.stationary_as_unknown}};
}

Json to_json(const metrics::MapQuality& map) {
  return {{"precision", number(map.precision())}, {"recall", number(map.recall())},
          {"residue", number(map.residue())},     {"occupied_cells", map.occupied_cells},
          {"residue_cells", map.residue_cells},   {"wall_samples", map.wall_samples}};
}

Json to_json(const metrics::MapSharpness& map) {
  return {{"mean_entropy_bits", number(map.mean_entropy_bits())},
          {"entropy_bits", number(map.entropy_bits)},
          {"touched_cells", map.touched_cells},
          {"occupied_cells", map.occupied_cells}};
}

Json to_json(const WallSharpness& walls, double cell_size_m) {
  return {{"cell_size_m", cell_size_m},
          {"scans", walls.scans},
          {"by_result", to_json(walls.of_estimate)},
          {"by_truth", to_json(walls.of_truth)}};
}

Json to_json(const std::array<traffic::WayAccuracy, traffic::kMovers>& accuracy) {
  Json kinds = Json::object();
  for (std::size_t kind = 0; kind < accuracy.size(); ++kind)
    kinds[name_of(static_cast<traffic::Mover>(kind))] = {
        {"travelled_in_view_m", number(accuracy[kind].travelled_m)},
        {"found_m", number(accuracy[kind].found_m)},
        {"recall", number(accuracy[kind].recall())},
        {"length_m", number(accuracy[kind].length_m)},
        {"true_m", number(accuracy[kind].true_m)},
        {"precision", number(accuracy[kind].precision())}};
  return kinds;
}

Json to_json(const WayEvaluation& ways) {
  return {{"all", to_json(ways.all)},
          {"least_confidence", number(ways.least_confidence)},
          {"confident", to_json(ways.confident)}};
}

Json to_json(const EvaluationOptions& options) {
  return {{"range_m", options.rule.range_m},
          {"first_bearing_rad", options.rule.first_bearing_rad},
          {"last_bearing_rad", options.rule.last_bearing_rad},
          {"least_speed_mps", options.rule.least_speed_mps},
          {"least_points", options.rule.least_points},
          {"dont_care_margin_m", options.rule.dont_care_margin_m},
          {"gate_m", options.rule.gate_m},
          {"similarity_reach_m", options.rule.similarity_reach_m},
          {"max_stamp_difference_s", options.max_stamp_difference_s},
          {"longest_occlusion_s", options.longest_occlusion_s},
          {"map_tolerance_m", options.map_tolerance_m}};
}

}  // namespace

std::string to_json_text(const Evaluation& evaluation, const EvaluationOptions& options) {
  Json json = {{"rule", to_json(options)},
               {"trajectory", to_json(evaluation.corrected)},
               {"online_trajectory", to_json(evaluation.online)}};
  if (evaluation.without_loops)
    json["trajectory_without_loops"] = to_json(*evaluation.without_loops);
  if (evaluation.relative_pose_nees)
    json["relative_pose_nees"] = to_json(*evaluation.relative_pose_nees);
  if (evaluation.detection) {
    json["detection"] = {{"scans", evaluation.detection->scans},
                         {"by_detection", to_json(evaluation.detection->by_detection)},
                         {"by_tracking", to_json(evaluation.detection->by_tracking)}};
  }
  if (evaluation.tracking) json["tracking"] = to_json(*evaluation.tracking);
  if (evaluation.occlusion) json["occlusion"] = to_json(*evaluation.occlusion);
  if (evaluation.other_car) json["other_car"] = to_json(*evaluation.other_car);
  if (evaluation.ways) json["ways"] = to_json(*evaluation.ways);
  if (evaluation.map) json["map"] = to_json(*evaluation.map);
  if (evaluation.walls) json["walls"] = to_json(*evaluation.walls, options.walls.cell_size_m);
  json["notes"] = evaluation.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace slammot::evaluator
