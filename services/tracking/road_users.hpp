#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace slammot::tracking {

/// Kinds of road users with sides; what is smaller is a blob.
enum class Kind : std::uint8_t { kBicycle, kCar, kTruck, kBus };

/// Means and one sigma of the sizes of one kind, and how common it is.
struct KindOfBody {
  Kind kind = Kind::kCar;
  double share = 0.0, length_m = 0.0, length_sigma_m = 0.0, width_m = 0.0, width_sigma_m = 0.0;
  double log_share = std::log(share);
  double width_sigma_if_askew_m = std::hypot(width_sigma_m, 0.06 * length_m);  ///< A heading that is a little off makes a body wider the longer it is.
};

/// Those of real road users anywhere.
inline const std::array<KindOfBody, 4> kKinds = {{{Kind::kBicycle, 0.14, 1.75, 0.2, 0.65, 0.15},
                                                  {Kind::kCar, 0.75, 4.4, 0.4, 1.8, 0.12},
                                                  {Kind::kTruck, 0.07, 7.0, 1.2, 2.35, 0.2},
                                                  {Kind::kBus, 0.04, 12.0, 1.2, 2.5, 0.12}}};

/// A size of a body: how long or wide it is believed to be.
struct Size {
  double value_m = 0.0;
  double variance_m2 = 1.0;
};

/// How deep the corners of vehicles are, of real ones: nothing of them is nearer to where two sides would meet, measured along both
/// together. Of an exact box nothing, where a corner is cut what is cut of either side, of a quarter circle 0.6 of its radius.
inline constexpr Size kCorner{0.2, 0.15 * 0.15};

/// What is known of the road users of a place, of real sizes.
struct RoadUsers {
  /// First each kind as it is here, then each as it is anywhere: one in so many here is like those elsewhere. Shares of none are left out.
  std::array<KindOfBody, 2 * kKinds.size()> kinds = {kKinds[0], kKinds[1], kKinds[2], kKinds[3]};
  Size corner = kCorner;
  /// How far bodies are from boxes, as a share of what the settings take for it: little of exact ones. At most 1.
  double shape_share = 1.0;
  /// How far who walks is off the middle of what is seen of them, as a share of the deviation that the settings take for it: little
  /// where it is coats, much where it is legs. At most 1.
  double swing_share = 1.0;
};

/// Those anywhere, where nothing is known of a place.
inline const RoadUsers kRoadUsersAnywhere;

/// Learns what the road users of a place are like from those that were seen from end to end.
class RoadUsersSeen {
 public:
  void add_length(Kind kind, const Size& seen) { sizes_[index(kind)].length.add(seen); }
  void add_width(Kind kind, const Size& seen) { sizes_[index(kind)].width.add(seen); }
  void add_corner(const Size& seen) { corner_.add(seen); }
  /// How far echoes lay off the sides of a body in the mean, beyond what grows with range, as a share of range_noise_m.
  void add_off_sides_share(double share) { off_sides_share_.add({share, 0.0}); }
  /// How far one who walked was off the middle of what was seen, as a share of the deviation that the settings take for it.
  void add_swing_share(double share) { swing_share_.add({share, 0.0}); }

  /// With nothing seen, those anywhere.
  RoadUsers known() const;

 private:
  /// Sizes of several bodies, each measured with an error.
  struct Sample {
    double count = 0.0;
    double mean_m = 0.0;
    double squares_m2 = 0.0;        ///< Sum of the squared deviations from the mean.
    double error_m2 = 0.0;          ///< Sum of the variances of the errors.

    void add(const Size& seen);
    double degrees() const { return count > 1.0 ? count - 1.0 : 0.0; }
    double true_squares_m2() const; ///< Of the sizes themselves.
  };
  struct Sizes {
    Sample length;
    Sample width;
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
