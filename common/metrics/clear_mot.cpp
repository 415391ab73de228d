#include "common/metrics/clear_mot.hpp"

#include <optional>
#include <utility>

namespace slammot::metrics {
namespace {

constexpr double kWorthOfContinuity = 1000.0;  // exceeds the sum of all similarities of a scan

struct ObjectHistory {
  std::size_t rows = 0;
  std::size_t matched_rows = 0;
  std::size_t beginnings = 0;
  std::optional<std::size_t> last_track;
  std::optional<std::size_t> track_in_scan_before;
};

Eigen::MatrixXd scores(const MotFrame& frame, const std::vector<ObjectHistory>& history,
                       double least_similarity) {
  Eigen::MatrixXd score = Eigen::MatrixXd::Zero(frame.similarity.rows(), frame.similarity.cols());
  for (Eigen::Index row = 0; row < score.rows(); ++row) {
    for (Eigen::Index column = 0; column < score.cols(); ++column) {
      const double similarity = frame.similarity(row, column);
      if (similarity < least_similarity - kRoundOff) continue;
      const bool goes_on = history[frame.objects[row]].track_in_scan_before == frame.tracks[column];
      score(row, column) = similarity + (goes_on ? kWorthOfContinuity : 0.0);
    }
  }
  return score;
}

void note_matches(const MotFrame& frame, const std::vector<Match>& matches,
                  std::vector<ObjectHistory>& history, ClearMot& result) {
  std::vector<std::optional<std::size_t>> before(history.size());
  for (std::size_t object = 0; object < history.size(); ++object)
    before[object] = std::exchange(history[object].track_in_scan_before, std::nullopt);
  for (const auto& [row, column] : matches) {
    ObjectHistory& object = history[frame.objects[row]];
    const std::size_t track = frame.tracks[column];
    if (object.last_track && *object.last_track != track) ++result.switches;
    if (!before[frame.objects[row]]) ++object.beginnings;
    ++object.matched_rows;
    object.last_track = track;
    object.track_in_scan_before = track;
    result.motp +=
        frame.similarity(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  }
}

void count_objects(const std::vector<ObjectHistory>& history, ClearMot& result) {
  for (const ObjectHistory& object : history) {
    if (object.beginnings > 1) result.fragmentations += object.beginnings - 1;
    if (object.rows == 0) continue;
    const double share =
        static_cast<double>(object.matched_rows) / static_cast<double>(object.rows);
    if (share > 0.8) ++result.mostly_tracked;
    if (share < 0.2) ++result.mostly_lost;
  }
}

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

ClearMot clear_mot(const MotSequence& sequence, double least_similarity) {
  ClearMot result;
  std::vector<ObjectHistory> history(sequence.object_count);
  for (const MotFrame& frame : sequence.frames) {
    for (const std::size_t object : frame.objects) ++history[object].rows;
    result.matches.push_back(best_pairs(scores(frame, history, least_similarity)));
    const std::size_t matched = result.matches.back().size();
    // trackeval skips scans without objects or without tracks.
    if (!frame.objects.empty() && !frame.tracks.empty())
      note_matches(frame, result.matches.back(), history, result);
    result.true_positives += matched;
    result.false_positives += frame.tracks.size() - matched;
    result.misses += frame.objects.size() - matched;
  }
  count_objects(history, result);
  const std::size_t objects = result.true_positives + result.misses;
  result.motp =
      result.true_positives == 0 ? 0.0 : result.motp / static_cast<double>(result.true_positives);
  result.recall = ratio(result.true_positives, objects);
  result.precision = ratio(result.true_positives, result.true_positives + result.false_positives);
  result.mota = result.recall - ratio(result.false_positives + result.switches, objects);
  return result;
}

}  // namespace slammot::metrics
