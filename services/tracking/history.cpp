#include "services/tracking/history.hpp"

#include <utility>

namespace slammot::tracking {

Observation StoredObservation::with_points() const {
  Observation seen = observation;
  seen.points_m = points_m;
  return seen;
}

void ObservationHistory::add(std::int64_t stamp_ns, const Observation& observation,
                             const Eigen::Matrix2d& pose_covariance_m2) {
  if (stored_.size() == kMost) stored_.pop_front();
  StoredObservation& stored = stored_.push_back();
  stored.stamp_ns = stamp_ns;
  stored.points_m.assign(observation.points_m.begin(), observation.points_m.end());
  stored.observation = observation;
  stored.pose_covariance_m2 = pose_covariance_m2;
}

History emptied(History used) {
  History history;
  history.observations = std::move(used.observations);
  history.past_points = std::move(used.past_points);
  clear_tentative(history);
  return history;
}

void clear_tentative(History& history) {
  history.observations.clear();
  history.past_points.clear();
}

}  // namespace slammot::tracking
