#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/flow/scan_labels.hpp"
#include "common/memory/recycling_queue.hpp"
#include "services/tracking/kinematics.hpp"
#include "services/tracking/observation.hpp"

namespace slammot::tracking {

/// An observation with its points, kept for refiltering.
struct StoredObservation {
  std::int64_t stamp_ns = 0;              ///< Of its beams, not of the scan.
  std::vector<Eigen::Vector2d> points_m;  ///< Copied.
  Observation observation;                ///< Its own points may be gone: use with_points().
  Eigen::Matrix2d pose_covariance_m2 = Eigen::Matrix2d::Zero();

  /// The observation of the stored points; valid while this is.
  Observation with_points() const;
};

/// The last observations of a track, oldest first.
class ObservationHistory {
 public:
  static constexpr std::size_t kMost = 40;  ///< The oldest ones beyond this are dropped.

  void add(std::int64_t stamp_ns, const Observation& observation,
           const Eigen::Matrix2d& pose_covariance_m2);
  void clear() { stored_.clear(); }
  std::size_t size() const { return stored_.size(); }
  /// 0: the oldest.
  const StoredObservation& operator[](std::size_t i) const { return stored_[i]; }

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) { visit(self.stored_); }

 private:
  memory::RecyclingQueue<StoredObservation> stored_;
};

/// Points of a track in an earlier scan.
struct PastPoints {
  std::size_t scanner = 0;  ///< Index of the scanner, in the order of their first scans.
  flow::RestoredPoints points;
};

/// When, where and by which scanner an object was observed.
/// Invariant: observations and past points are those of a tentative track; confirmation clears
/// them.
struct History {
  std::int64_t first_seen_ns = 0;
  std::int64_t last_seen_ns = 0;
  MeasuredCentre birth;  ///< Where it was first seen, by its present extent.
  ObservationHistory observations;
  memory::RecyclingQueue<PastPoints> past_points;  ///< Newest last.
  std::size_t scanner = 0;       ///< The last scanner that had it in its field of view.
  double since_in_view_s = 0.0;  ///< Since the last scan that had it in its field of view.
  std::optional<std::int64_t> first_published_ns;
  int misses = 0;                ///< Scans in a row that had it in view, without an echo.
  bool is_hidden = false;        ///< Nothing is expected to be seen of it: it takes no echoes.
  bool is_unseen = false;        ///< Partly hidden or more, and without an echo since.
  double expected_passed = 0.0;  ///< Expected share of the beams that pass it, where unseen.
};

/// An empty history in the memory of one that is no longer needed.
History emptied(History used);

/// Drops what only a tentative track needs.
void clear_tentative(History& history);

}  // namespace slammot::tracking
