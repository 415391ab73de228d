// Reads cases as JSON from the standard input and writes what common/metrics says of each: for
// evaluation_test.py, which asks independent programs the same.
#include <iostream>

#include <nlohmann/json.hpp>

#include "common/metrics/chi_square.hpp"
#include "common/metrics/clear_mot.hpp"
#include "common/metrics/gospa.hpp"
#include "common/metrics/hota.hpp"
#include "common/metrics/identity.hpp"
#include "common/metrics/matching.hpp"
#include "common/metrics/statistics.hpp"
#include "common/metrics/trajectory.hpp"

namespace {

using nlohmann::json;
using namespace slammot::metrics;

Trajectory trajectory_of(const json& rows) {
  Trajectory trajectory;
  for (const json& row : rows)
    trajectory.push_back({std::llround(row[0].get<double>() * 1e9), {row[1], row[2], row[3]}});
  return trajectory;
}

Eigen::MatrixXd matrix_of(const json& rows, std::size_t row_count, std::size_t column_count) {
  Eigen::MatrixXd matrix(row_count, column_count);
  for (std::size_t i = 0; i < row_count; ++i) {
    for (std::size_t j = 0; j < column_count; ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
  }
  return matrix;
}

json to_json(const ErrorSummary& errors) {
  return {{"count", errors.count},
          {"rmse", errors.rmse},
          {"mean", errors.mean},
          {"median", errors.median},
          {"max", errors.max}};
}

json relative(const std::vector<PosePair>& pairs, double delta_m, PathPairs pairing) {
  std::vector<slammot::geometry::Pose2> poses;
  // As the test asks of evo: consecutive pairs by the estimate's path, all pairs by the true one.
  for (const PosePair& pair : pairs)
    poses.push_back(pairing == PathPairs::kConsecutive ? pair.estimate : pair.truth);
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
  for (const RelativeError& error :
       relative_errors(pairs, pairs_by_path(poses, delta_m, pairing))) {
    translation_m.push_back(error.translation_m);
    rotation_rad.push_back(error.rotation_rad);
  }
  return {{"translation", to_json(summarize(translation_m))},
          {"rotation", to_json(summarize(rotation_rad))}};
}

json evaluate_trajectory(const json& one) {
  const auto pairs =
      associate(trajectory_of(one["truth"]), trajectory_of(one["estimate"]), 10'000'000);
  json answer = {
      {"pairs", pairs.size()},
      {"ate", to_json(summarize(absolute_errors_m(pairs, align_rigidly(pairs))))},
      {"ate_first_pose", to_json(summarize(absolute_errors_m(pairs, align_first_pose(pairs))))}};
  for (const json& delta : one["deltas"]) {
    answer["consecutive"].push_back(relative(pairs, delta, PathPairs::kConsecutive));
    answer["all"].push_back(relative(pairs, delta, PathPairs::kAll));
  }
  return answer;
}

json evaluate_tracking(const json& one) {
  MotSequence sequence{one["objects"], one["tracks"], {}};
  for (const json& frame : one["frames"]) {
    MotFrame next{0, frame["objects"], frame["tracks"], {}};
    next.similarity = matrix_of(frame["similarity"], next.objects.size(), next.tracks.size());
    sequence.frames.push_back(next);
  }
  const double gate = one["least_similarity"];
  const ClearMot clear = clear_mot(sequence, gate);
  const Identity id = identity(sequence, gate);
  const Hota higher = hota(sequence);
  return {{"tp", clear.true_positives},
          {"fp", clear.false_positives},
          {"fn", clear.misses},
          {"switches", clear.switches},
          {"fragmentations", clear.fragmentations},
          {"mostly_tracked", clear.mostly_tracked},
          {"mostly_lost", clear.mostly_lost},
          {"mota", clear.mota},
          {"motp", clear.motp},
          {"idtp", id.true_positives},
          {"idfp", id.false_positives},
          {"idfn", id.false_negatives},
          {"idf1", id.f1},
          {"hota_at", higher.hota_at},
          {"hota", higher.hota},
          {"deta", higher.detection_accuracy},
          {"assa", higher.association_accuracy},
          {"detre", higher.detection_recall},
          {"detpr", higher.detection_precision},
          {"loca", higher.localization_accuracy}};
}

json evaluate_gospa(const json& one) {
  const Gospa result =
      gospa(matrix_of(one["distance"], one["rows"], one["columns"]), one["cutoff"]);
  return {{"distance", result.distance_m},
          {"localization", result.localization_m2},
          {"missed", result.missed_m2},
          {"false", result.false_tracks_m2}};
}

json evaluate_pairing(const json& one) {
  const Eigen::MatrixXd score = matrix_of(one["score"], one["rows"], one["columns"]);
  double sum = 0.0;
  for (const auto& [row, column] : best_pairs(score))
    sum += score(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  return sum;
}

}  // namespace

int main() {
  const json cases = json::parse(std::cin);
  json answers;
  for (const json& one : cases["trajectories"])
    answers["trajectories"].push_back(evaluate_trajectory(one));
  for (const json& one : cases["tracking"]) answers["tracking"].push_back(evaluate_tracking(one));
  for (const json& one : cases["gospa"]) answers["gospa"].push_back(evaluate_gospa(one));
  for (const json& one : cases["pairings"]) answers["pairings"].push_back(evaluate_pairing(one));
  for (const json& one : cases["chi_square"])
    answers["chi_square"].push_back(chi_square_quantile(one[0], one[1]));
  std::cout << answers << "\n";
}
