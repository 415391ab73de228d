#include "services/evaluator/vehicle_boxes_csv.hpp"

#include "common/files/text.hpp"

namespace slammot::evaluator {
namespace {

double distance_m(const metrics::TrueObject& object, const metrics::Scene& scene) {
  return (object.world_from_object.translation_m() - scene.world_from_base.translation_m()).norm();
}

std::string line_of(const metrics::VehicleBoxRow& row, const Evaluation& evaluation) {
  const metrics::Scene& scene = evaluation.scenes[row.scan];
  const metrics::TrueObject& object = scene.objects[row.object];
  const metrics::ReportedTrack& track = scene.tracks[row.track];
  return files::text(
      "%.6f,%zu,%s,%u,%.2f,%d,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,%.4f,%.4f\n",
      static_cast<double>(scene.stamp_ns) * 1e-9, object.object, object.object_class.c_str(),
      evaluation.track_ids[track.track], distance_m(object, scene), object.points,
      object.outline_seen, object.speed_mps, object.length_m, object.width_m, track.length_m,
      track.width_m, row.iou, row.object_from_track.x_m, row.object_from_track.y_m,
      row.object_from_track.heading_rad, row.velocity_mps);
}

}  // namespace

std::string vehicle_boxes_csv(const Evaluation& evaluation) {
  std::string lines =
      "stamp_s,object,class,track,distance_m,points,outline_seen,speed_mps,true_length_m,"
      "true_width_m,length_m,width_m,iou,ahead_m,left_m,turned_rad,velocity_error_mps\n";
  if (!evaluation.tracking) return lines;
  for (const metrics::VehicleBoxRow& row :
       metrics::vehicle_box_rows(evaluation.scenes, evaluation.counted, evaluation.tracking->clear))
    lines += line_of(row, evaluation);
  return lines;
}

}  // namespace slammot::evaluator
