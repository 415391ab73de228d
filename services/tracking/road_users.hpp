#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/flow/tracked_objects.hpp"

namespace slammot::tracking {

/// Kinds of road users that are boxes; smaller ones are blobs. They refine the published classes by
/// size.
enum class Kind : std::uint8_t { kBicycle, kCar, kTruck, kBus };

/// The class of a kind: trucks and buses are one.
constexpr flow::ObjectClass class_of(Kind kind) {
  if (kind == Kind::kBicycle) return flow::ObjectClass::kBicycle;
  return kind == Kind::kCar ? flow::ObjectClass::kCar : flow::ObjectClass::kTruckOrBus;
}

/// Prior of one kind: its share, mean sizes and sigmas.
struct KindOfBody {
  Kind kind = Kind::kCar;
  double share = 0.0, length_m = 0.0, length_sigma_m = 0.0, width_m = 0.0, width_sigma_m = 0.0;
  double log_share = std::log(share);
  double width_sigma_if_askew_m = std::hypot(width_sigma_m, 0.06 * length_m);  ///< With the error
                                                                               ///< of a box turned
                                                                               ///< a little, which
                                                                               ///< grows with its
                                                                               ///< length.
};

/// Of real road users anywhere.
inline const std::array<KindOfBody, 4> kKinds = {{{Kind::kBicycle, 0.14, 1.75, 0.2, 0.65, 0.15},
                                                  {Kind::kCar, 0.75, 4.4, 0.4, 1.8, 0.12},
                                                  {Kind::kTruck, 0.07, 7.0, 1.2, 2.35, 0.2},
                                                  {Kind::kBus, 0.04, 12.0, 1.2, 2.5, 0.12}}};

/// Mean and variance of a size.
struct Size {
  double value_m = 0.0;
  double variance_m2 = 1.0;
};

/// Depth of the corners of real vehicles: the sum of the distances along both sides from their
/// intersection to the nearest part. 0 for an exact box, the cut length of either side for a cut,
/// 0.6 radii for a quarter circle.
inline constexpr Size kCorner{0.2, 0.15 * 0.15};

/// Priors of the road users of a place, in real sizes.
struct RoadUsers {
  /// First each kind as it is here, then each as it is anywhere: some here are like those
  /// elsewhere. Kinds of share 0 are skipped.
  std::array<KindOfBody, 2 * kKinds.size()> kinds = {kKinds[0], kKinds[1], kKinds[2], kKinds[3]};
  Size corner = kCorner;
  /// Deviation of the shapes from boxes relative to the configured one; at most 1.
  double shape_share = 1.0;
  /// Sigma of the gait relative to the configured one: small for coats, large for legs; at most 1.
  double swing_share = 1.0;
};

/// The prior where nothing is known of a place.
inline const RoadUsers kRoadUsersAnywhere;

/// Learns the priors of a place from road users that were seen from end to end: empirical Bayes, a
/// hierarchy of places and road users.
class RoadUsersSeen {
 public:
  void add_length(Kind kind, const Size& seen) { sizes_[index(kind)].length.add(seen); }
  void add_width(Kind kind, const Size& seen) { sizes_[index(kind)].width.add(seen); }
  void add_corner(const Size& seen) { corner_.add(seen); }
  /// Mean distance of the echoes from the sides of a box, beyond what grows with range, relative to
  /// range_noise_m.
  void add_off_sides_share(double share) { off_sides_share_.add({share, 0.0}); }
  /// Sigma of a pedestrian's gait relative to the configured one.
  void add_swing_share(double share) { swing_share_.add({share, 0.0}); }

  /// The priors so far; those anywhere if nothing was added.
  RoadUsers known() const;

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) {
    visit(self.sizes_, self.corner_, self.off_sides_share_, self.swing_share_);
  }

 private:
  /// Sizes of several road users, each with a measurement error.
  struct Sample {
    double count = 0.0;
    double mean_m = 0.0;
    double squares_m2 = 0.0;  ///< Sum of squared deviations from the mean.
    double error_m2 = 0.0;    ///< Sum of the error variances.

    void add(const Size& seen);
    double degrees() const { return count > 1.0 ? count - 1.0 : 0.0; }
    double true_squares_m2() const;  ///< Without the errors.
    static void visit_state(auto& self, auto& visit) {
      visit(self.count, self.mean_m, self.squares_m2, self.error_m2);
    }
  };
  struct Sizes {
    Sample length;
    Sample width;
    static void visit_state(auto& self, auto& visit) { visit(self.length, self.width); }
  };

  static std::size_t index(Kind kind) { return static_cast<std::size_t>(kind); }
  static Size next(const Sample& sample, double mean_m, double sigma_m, double spread_share);
  double spread_share() const;
  double shape_share() const;
  double swing_share() const;

  std::array<Sizes, kKinds.size()> sizes_;
  Sample corner_;
  Sample off_sides_share_;
  Sample swing_share_;
};

}  // namespace slammot::tracking
