#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/filters/gaussian.hpp"
#include "common/stages/tracking_stage.hpp"

namespace slammot::greedy_tracker {

struct GreedyTrackerConfig {
  double fastest_mps = 20.0;          ///< Two sigma of a new track's velocity, on each axis.
  double acceleration_density = 4.0;  ///< Power spectral density of the white acceleration
                                      ///< [m^2/s^3].
  double position_sigma_m = 0.1;  ///< One sigma of the box centre as a measurement of the object's
                                  ///< centre.
  double position_sigma_per_m = 0.2;      ///< Increase of that sigma per metre of the box's length:
                                          ///< often only one side is visible.
  double gate_share = 0.99;               ///< Share of true pairs inside the gate.
  std::size_t min_initiation_points = 3;  ///< Fewest points of a moving segment that initiates a
                                          ///< track.
  int least_hits = 10;                    ///< Measurements before a track is confirmed.
  double least_travel_m = 1.0;    ///< Distance from its first position before a track is confirmed:
                                  ///< errors of the map do not move.
  double longest_unseen_s = 0.6;  ///< Time without measurement after which a confirmed track is
                                  ///< deleted.
  double longest_unseen_tentative_s = 0.1;  ///< Time without measurement after which a tentative
                                            ///< track is deleted.
};

/// Nearest-neighbour tracking: gates (Wang 2004, Eqs. 5.8-5.9), assigns greedily by Mahalanobis
/// distance, and runs one constant-velocity Kalman filter per track. No occlusion, no shape beyond
/// the largest box seen, no class, no second hypothesis.
class GreedyTracker final : public stages::TrackingStage {
 public:
  explicit GreedyTracker(const GreedyTrackerConfig& config) : config_(config) {}

  const stages::TrackingResult& step(const flow::SegmentedScan& scan) override;
  std::map<std::string, std::uint64_t> named_counters() const override;

 private:
  struct Track {
    flow::TrackedObject object;    ///< Id, times, state of confirmation, and the largest box so far
                                   ///< with its heading.
    filters::Gaussian<4> state{};  ///< (x, y [m], vx, vy [m/s]) in odom.
    Eigen::Vector2d first_m{};     ///< Position of the first measurement.
    int hits = 1;
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  void predict(std::int64_t stamp_ns);
  std::vector<std::size_t> segment_of_each_track(const std::vector<flow::Segment>& segments) const;
  void correct(Track& track, const flow::Segment& segment, std::int64_t stamp_ns);
  void begin_track(const flow::Segment& segment, std::int64_t stamp_ns);
  void delete_unseen(std::int64_t stamp_ns);
  flow::TrackedObject described(const Track& track) const;

  GreedyTrackerConfig config_;
  std::vector<Track> tracks_;
  stages::TrackingResult result_;  ///< Of the last step().
  std::int64_t last_stamp_ns_ = 0;
  std::uint32_t next_id_ = 1;
  std::uint64_t scans_ = 0;
  std::uint64_t late_scans_ = 0;
  std::uint64_t tracks_confirmed_ = 0;
};

}  // namespace slammot::greedy_tracker
