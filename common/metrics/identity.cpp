#include "common/metrics/identity.hpp"

namespace slammot::metrics {
namespace {

/// Number of scans in which the pair is similar enough; row an object, column a track.
Eigen::MatrixXd common_rows(const MotSequence& sequence, double least_similarity) {
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(sequence.object_count),
                                                 static_cast<Eigen::Index>(sequence.track_count));
  for (const MotFrame& frame : sequence.frames) {
    for (Eigen::Index row = 0; row < frame.similarity.rows(); ++row) {
      for (Eigen::Index column = 0; column < frame.similarity.cols(); ++column) {
        if (frame.similarity(row, column) >= least_similarity)
          common(static_cast<Eigen::Index>(frame.objects[row]),
                 static_cast<Eigen::Index>(frame.tracks[column])) += 1.0;
      }
    }
  }
  return common;
}

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

}  // namespace

Identity identity(const MotSequence& sequence, double least_similarity) {
  const Eigen::MatrixXd common = common_rows(sequence, least_similarity);
  // The assignment with the fewest false rows is that with the most common rows: each common row
  // saves one false row on either side.
  Identity result;
  for (const auto& [object, track] : best_pairs(common)) {
    result.true_positives += static_cast<std::size_t>(
        common(static_cast<Eigen::Index>(object), static_cast<Eigen::Index>(track)));
  }
  const std::size_t objects = sequence.object_rows();
  const std::size_t tracks = sequence.track_rows();
  result.false_negatives = objects - result.true_positives;
  result.false_positives = tracks - result.true_positives;
  const auto common_count = static_cast<double>(result.true_positives);
  result.f1 = ratio(2.0 * common_count, static_cast<double>(objects + tracks));
  result.precision = ratio(common_count, static_cast<double>(tracks));
  result.recall = ratio(common_count, static_cast<double>(objects));
  return result;
}

}  // namespace slammot::metrics
