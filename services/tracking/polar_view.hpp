#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/flow/segmented_scan.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::tracking {

/// What a scan shows at one place.
enum class Sight : std::uint8_t {
  kNothing,  ///< Out of view, or undecided.
  kThere,    ///< An echo from this place.
  kThrough,  ///< The beams passed beyond it.
  kHidden,   ///< An occluder is nearer.
  kEmpty,    ///< No echo, though near enough for most surfaces to answer.
};

struct SightOfPlace {
  Sight sight = Sight::kNothing;
  std::size_t beam = 0;  ///< The beam that decides.
};

/// The end points of the beams of one scan in odom, indexed by direction. Owns a copy of the scan's
/// points.
class PolarView {
 public:
  PolarView() = default;
  explicit PolarView(const flow::SegmentedScan& scan) { look_at(scan); }
  /// Replaces the scan; reuses the memory.
  void look_at(const flow::SegmentedScan& scan);

  std::size_t beam_count() const { return range_m_.size(); }
  const Eigen::Vector2d& point_in_odom_m(std::size_t beam) const { return points_in_odom_m_[beam]; }
  const Eigen::Vector2d& laser_in_odom_m() const { return laser_in_odom_m_; }
  double range_m(std::size_t beam) const { return static_cast<double>(range_m_[beam]); }
  double beam_step_rad() const { return beam_step_rad_; }  ///< Positive.
  bool goes_all_round() const { return goes_all_round_; }
  /// The beam this many steps on; none beyond the ends of the field of view, if it has ends.
  std::optional<std::size_t> neighbour_of(std::size_t beam, long steps) const;
  /// Steps from one beam forward to another, across the seam of a scan that goes all round; the
  /// number of beams where there is no such way.
  std::size_t steps_between(std::size_t from, std::size_t to) const;

  /// Prepares for many calls of sight_of(): the same answers, mostly without examining single
  /// beams.
  void measure_depths();

  /// What this scan shows at a place: consistency as in Wang 2004, Section 6.2, but between two
  /// scans, free of the map's errors.
  SightOfPlace sight_of(const Eigen::Vector2d& point_in_odom_m) const;

  /// True if an echo that counts lies within this distance of a place.
  bool any_echo_near(const Eigen::Vector2d& point_in_odom_m, double within_m,
                     const std::function<bool(std::size_t beam)>& counts) const;

  /// Direction in steps from beam 0, ascending with the beams, within half a turn of the middle of
  /// the field of view.
  double steps_towards(double direction_in_odom_rad) const;

  /// Time from the scan's stamp to the firing of a beam.
  double delay_s(std::size_t beam) const {
    return sensing::beam_delay_s(sweep_s_, beam, beam_count());
  }
  /// The same of the beam that points nearest to a place.
  double delay_towards_s(const Eigen::Vector2d& point_in_odom_m) const;

  /// Index of the beam nearest to the direction of a vector in odom, which may be outside of the
  /// scan: steps_towards() rounded, mostly without its arctangent.
  long beam_towards(const Eigen::Vector2d& way) const;

  /// Lists all but the depths, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) {
    visit(self.points_in_odom_m_, self.range_m_, self.laser_in_odom_m_,
          self.first_beam_in_odom_rad_, self.beam_step_rad_, self.beams_per_rad_, self.sweep_s_,
          self.half_view_rad_, self.middle_of_view_rad_, self.is_clockwise_, self.goes_all_round_);
  }
  /// False for a state that no scan leads to.
  bool is_sound() const;

 private:
  /// For each beam the interval of distances from the laser in which it and its neighbours met
  /// something; nearest > farthest where they met nothing. Empty where not measured.
  struct Depths {
    std::vector<double> nearest_m;
    std::vector<double> farthest_m;
  };

  bool may_have_met(long middle, double distance_m, double within_m) const;
  static constexpr std::size_t kNoBeam = static_cast<std::size_t>(-1);
  std::size_t beam_that_met(const Eigen::Vector2d& point_in_odom_m, long middle,
                            double within_m) const;

  std::vector<Eigen::Vector2d> points_in_odom_m_;
  Depths depths_;
  std::vector<float> range_m_;
  Eigen::Vector2d laser_in_odom_m_;
  double first_beam_in_odom_rad_ = 0.0;
  double beam_step_rad_ = 0.0;
  double beams_per_rad_ = 0.0;
  double sweep_s_ = 0.0;
  double half_view_rad_ = 0.0;
  double middle_of_view_rad_ = 0.0;  ///< In odom, counted as the beams go.
  bool is_clockwise_ = false;
  bool goes_all_round_ = false;
};

}  // namespace slammot::tracking
