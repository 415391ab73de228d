#include "common/metrics/hota.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace slammot::metrics {
namespace {

struct Pair {
  Eigen::Index object = 0;
  Eigen::Index track = 0;
  double similarity = 0.0;
};

struct Counts {
  Eigen::VectorXd rows_of_object;
  Eigen::VectorXd rows_of_track;
  Eigen::MatrixXd likely_common;  // over the scans, sum of the pair's share of all its similarities
};

Counts count(const MotSequence& sequence) {
  const auto objects = static_cast<Eigen::Index>(sequence.object_count);
  const auto tracks = static_cast<Eigen::Index>(sequence.track_count);
  Counts counts{Eigen::VectorXd::Zero(objects), Eigen::VectorXd::Zero(tracks),
                Eigen::MatrixXd::Zero(objects, tracks)};
  for (const MotFrame& frame : sequence.frames) {
    for (const std::size_t object : frame.objects)
      counts.rows_of_object(static_cast<Eigen::Index>(object)) += 1.0;
    for (const std::size_t track : frame.tracks)
      counts.rows_of_track(static_cast<Eigen::Index>(track)) += 1.0;
    if (frame.similarity.size() == 0) continue;
    const Eigen::VectorXd of_object = frame.similarity.rowwise().sum();
    const Eigen::RowVectorXd of_track = frame.similarity.colwise().sum();
    for (Eigen::Index row = 0; row < frame.similarity.rows(); ++row) {
      for (Eigen::Index column = 0; column < frame.similarity.cols(); ++column) {
        const double all = of_object(row) + of_track(column) - frame.similarity(row, column);
        if (all > kRoundOff)
          counts.likely_common(static_cast<Eigen::Index>(frame.objects[row]),
                               static_cast<Eigen::Index>(frame.tracks[column])) +=
              frame.similarity(row, column) / all;
      }
    }
  }
  return counts;
}

/// One assignment for all thresholds: it prefers pairs that match over the whole sequence.
std::vector<Pair> pair_up(const MotSequence& sequence, const Counts& counts) {
  std::vector<Pair> pairs;
  for (const MotFrame& frame : sequence.frames) {
    Eigen::MatrixXd score = frame.similarity;
    for (Eigen::Index row = 0; row < score.rows(); ++row) {
      for (Eigen::Index column = 0; column < score.cols(); ++column) {
        const auto object = static_cast<Eigen::Index>(frame.objects[row]);
        const auto track = static_cast<Eigen::Index>(frame.tracks[column]);
        const double common = counts.likely_common(object, track);
        score(row, column) *=
            common / (counts.rows_of_object(object) + counts.rows_of_track(track) - common);
      }
    }
    for (const auto& [row, column] : best_pairs(score)) {
      pairs.push_back(
          {static_cast<Eigen::Index>(frame.objects[row]),
           static_cast<Eigen::Index>(frame.tracks[column]),
           frame.similarity(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column))});
    }
  }
  return pairs;
}

struct AtThreshold {
  double true_positives = 0.0;
  double similarity = 0.0;   // sum
  double association = 0.0;  // mean over the true positives of the Jaccard index of the two whole
                             // tracks
};

AtThreshold measure(const std::vector<Pair>& pairs, const Counts& counts, double threshold) {
  AtThreshold result;
  Eigen::MatrixXd common =
      Eigen::MatrixXd::Zero(counts.likely_common.rows(), counts.likely_common.cols());
  for (const Pair& pair : pairs) {
    if (pair.similarity < threshold - kRoundOff) continue;
    result.true_positives += 1.0;
    result.similarity += pair.similarity;
    common(pair.object, pair.track) += 1.0;
  }
  for (Eigen::Index object = 0; object < common.rows(); ++object) {
    for (Eigen::Index track = 0; track < common.cols(); ++track) {
      const double rows = common(object, track);
      if (rows > 0.0)
        result.association +=
            rows * rows / (counts.rows_of_object(object) + counts.rows_of_track(track) - rows);
    }
  }
  result.association /= std::max(1.0, result.true_positives);
  return result;
}

}  // namespace

Hota hota(const MotSequence& sequence) {
  constexpr double kNothing = 1e-10;  // as in trackeval: without pairs the localization accuracy is
                                      // 1
  const Counts counts = count(sequence);
  const std::vector<Pair> pairs = pair_up(sequence, counts);
  const double objects = counts.rows_of_object.sum();
  const double tracks = counts.rows_of_track.sum();
  Hota result;
  for (std::size_t i = 0; i < kHotaThresholds; ++i) {
    const AtThreshold at = measure(pairs, counts, 0.05 * static_cast<double>(i + 1));
    const double detection =
        at.true_positives / std::max(1.0, objects + tracks - at.true_positives);
    result.hota_at[i] = std::sqrt(detection * at.association);
    const double share = 1.0 / static_cast<double>(kHotaThresholds);
    result.hota += share * result.hota_at[i];
    result.detection_accuracy += share * detection;
    result.association_accuracy += share * at.association;
    result.detection_recall += share * at.true_positives / std::max(1.0, objects);
    result.detection_precision += share * at.true_positives / std::max(1.0, tracks);
    result.localization_accuracy +=
        share * std::max(kNothing, at.similarity) / std::max(kNothing, at.true_positives);
  }
  return result;
}

}  // namespace slammot::metrics
