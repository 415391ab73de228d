#include "common/streets/street_proposals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Cholesky>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kSigma_m = 1.8;  // of a point across its street
constexpr double kSigma_rad = 0.08;
constexpr double kLaneSigma_m = 2.0;
constexpr double kOutlier = 9.0;         // squared error from which a point is beside all streets
constexpr double kProposalStep_m = 4.0;  // along streets
constexpr double kCoarseSigma_m = 8.0;   // of the first comparison, which is not refined
constexpr std::size_t kRefined = 800;    // proposals
constexpr double kSamePlace_m = 15.0;    // places nearer than this are one, everywhere on the way

/// Error of a point against the nearest street.
struct PointError {
  Vector2 left = Vector2::Zero();  ///< Unit vector across the street, to the left of the heading.
  double across_m = 0.0;           ///< To the left of the line.
  double heading_rad = 0.0;
};

std::optional<PointError> error_of(const StreetField& field, const Pose2& streets_from_base) {
  const auto nearest = field.nearest(streets_from_base);
  if (!nearest) return std::nullopt;
  PointError error;
  error.left = {-std::sin(nearest->direction_rad), std::cos(nearest->direction_rad)};
  const Vector2 away_m = streets_from_base.translation_m() - nearest->point_m;
  // Beyond the end of a street, the distance counts.
  const double side = error.left.dot(away_m) < 0.0 ? -1.0 : 1.0;
  const bool is_beyond_end = std::abs(error.left.dot(away_m)) < 0.7 * away_m.norm();
  error.across_m = is_beyond_end ? side * away_m.norm() : error.left.dot(away_m);
  if (is_beyond_end) error.left = side * away_m.normalized();
  error.heading_rad = geometry::wrap_angle(streets_from_base.heading_rad - nearest->direction_rad);
  return error;
}

class Matcher {
 public:
  Matcher(const StreetField& field, const std::vector<Pose2>& points)
      : field_(field), points_(points) {}

  /// Sum of bounded squared errors of the way's points; stops above `most`.
  double coarse_cost(const Pose2& streets_from_map, double most) const {
    double cost = 0.0;
    for (std::size_t i = 0; i < points_.size() && cost < most; i += 2)
      cost +=
          bounded(squared(error_of(field_, streets_from_map * points_[i]), 0.0, kCoarseSigma_m));
    return cost;
  }

  struct Refined {
    Pose2 streets_from_map;
    double cost = 0.0;
  };

  /// Least squares over the points on streets, with the lane as a fourth unknown.
  Refined refined(Pose2 streets_from_map) const {
    double lane_m = 0.0;
    for (const double sigma_m : {8.0, 8.0, 5.0, 5.0, 3.5, 2.5, 2.5, 2.5, 2.5, 2.5})
      step(sigma_m, streets_from_map, lane_m);
    double cost = 0.0;
    for (const Pose2& point : points_)
      cost += bounded(squared(error_of(field_, streets_from_map * point), lane_m, kSigma_m));
    return {streets_from_map, cost};
  }

 private:
  double squared(const std::optional<PointError>& error, double lane_m, double sigma_m) const {
    if (!error) return kOutlier;
    const double across = (error->across_m - lane_m) / sigma_m;
    const double turn = error->heading_rad / kSigma_rad;
    return across * across + turn * turn;
  }
  static double bounded(double squared) { return std::min(squared, kOutlier); }

  /// One step of Gauss and Newton about the way's middle.
  void step(double sigma_m, Pose2& streets_from_map, double& lane_m) const {
    Eigen::Matrix4d information = 1e-6 * Eigen::Matrix4d::Identity();
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    information(3, 3) += 1.0 / (kLaneSigma_m * kLaneSigma_m);
    gradient(3) += lane_m / (kLaneSigma_m * kLaneSigma_m);
    const Vector2 middle_m = streets_from_map * points_[points_.size() / 2].translation_m();
    for (const Pose2& point : points_) {
      const Pose2 placed = streets_from_map * point;
      const auto error = error_of(field_, placed);
      if (squared(error, lane_m, sigma_m) >= kOutlier) continue;
      const Vector2 arm_m = placed.translation_m() - middle_m;
      const Eigen::Vector4d across{error->left.x(), error->left.y(),
                                   error->left.y() * arm_m.x() - error->left.x() * arm_m.y(), -1.0};
      information += across * across.transpose() / (sigma_m * sigma_m);
      gradient += across * (error->across_m - lane_m) / (sigma_m * sigma_m);
      const double of_heading = 1.0 / (kSigma_rad * kSigma_rad);
      information(2, 2) += of_heading;
      gradient(2) += of_heading * error->heading_rad;
    }
    // Along a straight way nothing holds the place: damped, it stays.
    information.topLeftCorner<2, 2>().diagonal().array() += 0.05;
    const Eigen::Vector4d change = -information.ldlt().solve(gradient);
    const geometry::Matrix2 turn = geometry::rotation(change(2));
    const Vector2 moved_m = turn * (streets_from_map.translation_m() - middle_m) + middle_m +
                            Vector2(change(0), change(1));
    streets_from_map = {moved_m.x(), moved_m.y(),
                        geometry::wrap_angle(streets_from_map.heading_rad + change(2))};
    lane_m += change(3);
  }

  const StreetField& field_;
  const std::vector<Pose2>& points_;
};

struct Proposal {
  Pose2 streets_from_map;
  double cost = std::numeric_limits<double>::infinity();
};

/// Keeps the cheapest proposal of each cell of places and directions of the way's middle.
class Shortlist {
 public:
  explicit Shortlist(const Pose2& middle) : middle_(middle) {}

  void add(const Pose2& streets_from_map, const Matcher& matcher) {
    const Cell cell = cell_of(streets_from_map);
    const auto known = best_.find(cell);
    const double most = known == best_.end() ? most_ : std::min(known->second.cost, most_);
    const double cost = matcher.coarse_cost(streets_from_map, most);
    if (cost >= most) return;
    best_[cell] = {streets_from_map, cost};
    if (++added_ >= kRefined + best_.size()) limit_costs();
  }
  std::vector<Proposal> finished() const {
    std::vector<Proposal> proposals;
    for (const auto& [cell, proposal] : best_) proposals.push_back(proposal);
    std::ranges::stable_sort(proposals, {}, &Proposal::cost);
    if (proposals.size() > kRefined) proposals.resize(kRefined);
    return proposals;
  }

 private:
  using Cell = std::array<int, 3>;

  /// Dearer proposals than the kRefined best so far are not among the best in the end; equal ones
  /// may be.
  void limit_costs() {
    added_ = 0;
    if (best_.size() < kRefined) return;
    std::vector<double> costs;
    costs.reserve(best_.size());
    for (const auto& [cell, proposal] : best_) costs.push_back(proposal.cost);
    const auto last = costs.begin() + static_cast<std::ptrdiff_t>(kRefined) - 1;
    std::ranges::nth_element(costs, last);
    most_ = std::nextafter(*last, std::numeric_limits<double>::infinity());
  }

  Cell cell_of(const Pose2& streets_from_map) const {
    constexpr double kCell_m = 8.0;
    constexpr double kCell_rad = 0.1;
    const Pose2 placed = streets_from_map * middle_;
    return {static_cast<int>(std::floor(placed.x_m / kCell_m)),
            static_cast<int>(std::floor(placed.y_m / kCell_m)),
            static_cast<int>(std::floor(placed.heading_rad / kCell_rad))};
  }

  Pose2 middle_;
  std::map<Cell, Proposal> best_;
  double most_ = std::numeric_limits<double>::infinity();  ///< Proposals cost less than this.
  std::size_t added_ = 0;                                  ///< Since the last change of most_.
};

/// Lays three points of the way onto streets, in both senses and some directions.
std::vector<Proposal> proposals(const StreetField& field, const Matcher& matcher,
                                const DrivenWay& way, const std::optional<StartArea>& start) {
  constexpr std::array<double, 7> kTurns_rad{0.0, -0.05, 0.05, -0.1, 0.1, -0.17, 0.17};
  Shortlist shortlist(way.points[way.points.size() / 2]);
  for (const std::size_t anchor :
       {std::size_t{0}, way.points.size() / 3, 2 * way.points.size() / 3}) {
    const Pose2 base_from_map = geometry::inverse(way.points[anchor]);
    for (const LinkSegment& part : field.segments()) {
      const Segment& segment = part.segment;
      const int steps = std::max(1, static_cast<int>(segment.length_m() / kProposalStep_m));
      for (int step = 0; step < steps; ++step) {
        const Vector2 at_m =
            segment.from_m + (step + 0.5) / steps * (segment.to_m - segment.from_m);
        for (const double sense_rad : {0.0, 3.14159265358979}) {
          for (const double turn_rad : kTurns_rad) {
            const Pose2 streets_from_base{
                at_m.x(), at_m.y(),
                geometry::wrap_angle(segment.direction_rad() + sense_rad + turn_rad)};
            const Pose2 streets_from_map = streets_from_base * base_from_map;
            if (!agrees_with_start(streets_from_map, way, start)) continue;
            shortlist.add(streets_from_map, matcher);
          }
        }
      }
    }
  }
  return shortlist.finished();
}

}  // namespace

bool agrees_with_start(const Pose2& streets_from_map, const DrivenWay& way,
                       const std::optional<StartArea>& start) {
  constexpr double kSlack = 1.05;
  if (!start) return true;
  const Vector2 begin_m = streets_from_map * way.points.front().translation_m();
  if (start->x_from_east_rad &&
      std::abs(geometry::wrap_angle(streets_from_map.heading_rad - *start->x_from_east_rad)) >
          start->direction_within_rad)
    return false;
  return (begin_m - start->centre_m).norm() <= kSlack * start->radius_m;
}

bool are_one_place(const Pose2& a, const Pose2& b, const DrivenWay& way) {
  return std::ranges::all_of(
      std::array{way.points.front(), way.points[way.points.size() / 2], way.points.back()},
      [&](const Pose2& point) {
        return (a * point.translation_m() - b * point.translation_m()).norm() < kSamePlace_m;
      });
}

std::vector<Pose2> proposed_places(const StreetField& field, const DrivenWay& way,
                                   const std::optional<StartArea>& start, std::size_t most) {
  const Matcher matcher(field, way.points);
  std::vector<Matcher::Refined> all;
  for (const Proposal& proposal : proposals(field, matcher, way, start)) {
    const Matcher::Refined refined = matcher.refined(proposal.streets_from_map);
    if (agrees_with_start(refined.streets_from_map, way, start)) all.push_back(refined);
  }
  std::ranges::stable_sort(all, {}, &Matcher::Refined::cost);
  std::vector<Pose2> places;
  for (const Matcher::Refined& refined : all) {
    const bool is_new = std::ranges::none_of(places, [&](const Pose2& known) {
      return are_one_place(known, refined.streets_from_map, way);
    });
    if (is_new && places.size() < most) places.push_back(refined.streets_from_map);
  }
  return places;
}

}  // namespace slammot::streets
