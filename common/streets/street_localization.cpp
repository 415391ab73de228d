#include "common/streets/street_localization.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "common/streets/street_field.hpp"

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kSpacing_m = 5.0;       // of the way's points
constexpr double kCorrelation_m = 20.0;  // errors of nearer points are not independent
constexpr double kOutlier = 9.0;         // squared error from which a point is beside all streets
constexpr double kProposalStep_m = 4.0;  // along streets
constexpr double kCoarseSigma_m = 8.0;   // of the first comparison, which is not refined
// Negative logarithms of probabilities: a street that is missing in the graph begins and ends, and
// each point on it.
constexpr double kLeave = 4.0;
constexpr double kReturn = 1.0;
constexpr double kOffStreets = 0.35;
constexpr std::size_t kRefined = 400;  // proposals
constexpr std::size_t kMostFits = 20;
constexpr double kSamePlace_m = 15.0;  // fits nearer than this are one, everywhere on the way
constexpr double kLeastShare = 0.6;    // of the way on streets
constexpr double kMargin_m = 60.0;     // around what the way can reach

/// The way at equal distances.
std::vector<Pose2> resampled(std::span<const Pose2> way) {
  std::vector<Pose2> points;
  for (const Pose2& pose : way) {
    if (points.empty()) points.push_back(pose);
    const Vector2 step_m = pose.translation_m() - points.back().translation_m();
    if (step_m.norm() < kSpacing_m) continue;
    points.push_back(pose);
  }
  return points;
}

double length_m(const std::vector<Pose2>& points) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum_m += (points[i].translation_m() - points[i - 1].translation_m()).norm();
  return sum_m;
}

/// Distance of the farthest point from the first one.
double reach_m(const std::vector<Pose2>& points) {
  double most_m = 0.0;
  for (const Pose2& point : points)
    most_m = std::max(most_m, (point.translation_m() - points.front().translation_m()).norm());
  return most_m;
}

Area area_of(const StreetGraph& graph, const std::vector<Pose2>& points,
             const std::optional<StartArea>& start) {
  if (start) return {start->centre_m, start->radius_m + reach_m(points) + kMargin_m};
  Vector2 low_m = Vector2::Constant(std::numeric_limits<double>::max());
  Vector2 high_m = -low_m;
  for (const Street& street : graph.streets) {
    for (const Vector2& point_m : street.line_m) {
      low_m = low_m.cwiseMin(point_m);
      high_m = high_m.cwiseMax(point_m);
    }
  }
  return {0.5 * (low_m + high_m), 0.5 * (high_m - low_m).maxCoeff() + kMargin_m};
}

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
  Matcher(const StreetField& field, const std::vector<Pose2>& points,
          const StreetLocalizationConfig& config)
      : field_(field), points_(points), config_(config) {}

  /// Sum of bounded squared errors of the way's points; stops above `most`.
  double coarse_cost(const Pose2& streets_from_map, double most) const {
    double cost = 0.0;
    for (std::size_t i = 0; i < points_.size() && cost < most; i += 2)
      cost +=
          bounded(squared(error_of(field_, streets_from_map * points_[i]), 0.0, kCoarseSigma_m));
    return cost;
  }

  /// Least squares over the points on streets, with the lane as a fourth unknown.
  StreetFit refined(Pose2 streets_from_map) const {
    double lane_m = 0.0;
    for (const double sigma_m : {8.0, 8.0, 5.0, 5.0, 3.5, 2.5, 2.5, 2.5, 2.5, 2.5})
      step(std::max(sigma_m, config_.sigma_m), streets_from_map, lane_m);
    return judged(streets_from_map, lane_m);
  }

 private:
  double squared(const std::optional<PointError>& error, double lane_m, double sigma_m) const {
    if (!error) return kOutlier;
    const double across = (error->across_m - lane_m) / sigma_m;
    const double turn = error->heading_rad / config_.sigma_rad;
    return across * across + turn * turn;
  }
  static double bounded(double squared) { return std::min(squared, kOutlier); }

  /// One step of Gauss and Newton about the way's middle.
  void step(double sigma_m, Pose2& streets_from_map, double& lane_m) const {
    Eigen::Matrix4d information = 1e-6 * Eigen::Matrix4d::Identity();
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    information(3, 3) += 1.0 / (config_.lane_sigma_m * config_.lane_sigma_m);
    gradient(3) += lane_m / (config_.lane_sigma_m * config_.lane_sigma_m);
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
      const double of_heading = 1.0 / (config_.sigma_rad * config_.sigma_rad);
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

  /// Cost of the most likely sequence of points on and off the streets (Viterbi).
  StreetFit judged(const Pose2& streets_from_map, double lane_m) const {
    constexpr double kPerPoint = 0.5 * kSpacing_m / kCorrelation_m;
    StreetFit fit{streets_from_map, 0.0, 0.0, 0.0};
    std::size_t on_streets = 0;
    double on = 0.0;
    double off = kLeave;
    for (const Pose2& point : points_) {
      const double error =
          squared(error_of(field_, streets_from_map * point), lane_m, config_.sigma_m);
      if (error < kOutlier) ++on_streets;
      const double next_on = std::min(on, off + kReturn) + kPerPoint * bounded(error);
      off = std::min(off, on + kLeave) + kOffStreets;
      on = next_on;
    }
    const double lane = lane_m / config_.lane_sigma_m;
    fit.cost = std::min(on, off) + 0.5 * lane * lane;
    fit.share = static_cast<double>(on_streets) / static_cast<double>(points_.size());
    return fit;
  }

  const StreetField& field_;
  const std::vector<Pose2>& points_;
  StreetLocalizationConfig config_;
};

struct Proposal {
  Pose2 streets_from_map;
  double cost = 0.0;
};

/// Keeps the cheapest proposals.
class Shortlist {
 public:
  double most() const { return most_; }
  void add(const Proposal& proposal) {
    proposals_.push_back(proposal);
    if (proposals_.size() >= 4 * kRefined) shorten();
  }
  std::vector<Proposal> finished() {
    shorten();
    return proposals_;
  }

 private:
  void shorten() {
    std::ranges::stable_sort(proposals_, {}, &Proposal::cost);
    if (proposals_.size() <= kRefined) return;
    proposals_.resize(kRefined);
    most_ = proposals_.back().cost;
  }

  std::vector<Proposal> proposals_;
  double most_ = std::numeric_limits<double>::infinity();
};

bool agrees_with_start(const Pose2& streets_from_map, const std::vector<Pose2>& points,
                       const std::optional<StartArea>& start) {
  constexpr double kSlack = 1.05;
  if (!start) return true;
  const Vector2 begin_m = streets_from_map * points.front().translation_m();
  if (start->x_from_east_rad &&
      std::abs(geometry::wrap_angle(streets_from_map.heading_rad - *start->x_from_east_rad)) >
          start->direction_within_rad)
    return false;
  return (begin_m - start->centre_m).norm() <= kSlack * start->radius_m;
}

/// Lays three points of the way onto streets, in both senses and some directions.
std::vector<Proposal> proposals(const StreetField& field, const Matcher& matcher,
                                const std::vector<Pose2>& points,
                                const std::optional<StartArea>& start) {
  constexpr std::array<double, 7> kTurns_rad{0.0, -0.05, 0.05, -0.1, 0.1, -0.17, 0.17};
  Shortlist shortlist;
  for (const std::size_t anchor : {std::size_t{0}, points.size() / 3, 2 * points.size() / 3}) {
    const Pose2 base_from_map = geometry::inverse(points[anchor]);
    for (const Segment& segment : field.segments()) {
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
            if (!agrees_with_start(streets_from_map, points, start)) continue;
            const double cost = matcher.coarse_cost(streets_from_map, shortlist.most());
            if (cost < shortlist.most()) shortlist.add({streets_from_map, cost});
          }
        }
      }
    }
  }
  return shortlist.finished();
}

bool are_one_place(const Pose2& a, const Pose2& b, const std::vector<Pose2>& points) {
  return std::ranges::all_of(
      std::array{points.front(), points[points.size() / 2], points.back()},
      [&](const Pose2& point) {
        return (a * point.translation_m() - b * point.translation_m()).norm() < kSamePlace_m;
      });
}

void set_probabilities(std::vector<StreetFit>& fits) {
  double sum = 0.0;
  for (const StreetFit& fit : fits) sum += std::exp(fits.front().cost - fit.cost);
  for (StreetFit& fit : fits) fit.probability = std::exp(fits.front().cost - fit.cost) / sum;
}

std::vector<StreetFit> distinct(std::vector<StreetFit> all, const std::vector<Pose2>& points) {
  std::ranges::stable_sort(all, {}, &StreetFit::cost);
  std::vector<StreetFit> fits;
  for (const StreetFit& fit : all) {
    const bool is_new = std::ranges::none_of(fits, [&](const StreetFit& known) {
      return are_one_place(known.streets_from_map, fit.streets_from_map, points);
    });
    if (is_new && fits.size() < kMostFits) fits.push_back(fit);
  }
  return fits;
}

/// Number of poses until this much of the way.
std::size_t poses_within(std::span<const Pose2> way, double most_m) {
  double travelled_m = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    travelled_m += (way[i].translation_m() - way[i - 1].translation_m()).norm();
    if (travelled_m > most_m) return i;
  }
  return way.size();
}

}  // namespace

StreetLocation locate(const StreetGraph& graph, std::span<const Pose2> way,
                      const std::optional<StartArea>& start,
                      const StreetLocalizationConfig& config) {
  StreetLocation location;
  const std::vector<Pose2> points = resampled(way);
  location.way_m = length_m(points);
  if (location.way_m < config.least_way_m) return location;
  location.verdict = StreetVerdict::kNotOnStreets;
  if (graph.streets.empty()) return location;
  const StreetField field(graph, area_of(graph, points, start));
  const Matcher matcher(field, points, config);
  std::vector<StreetFit> fits;
  for (const Proposal& proposal : proposals(field, matcher, points, start)) {
    const StreetFit fit = matcher.refined(proposal.streets_from_map);
    if (agrees_with_start(fit.streets_from_map, points, start)) fits.push_back(fit);
  }
  location.fits = distinct(std::move(fits), points);
  if (location.fits.empty() || location.fits.front().share < kLeastShare) return location;
  set_probabilities(location.fits);
  location.verdict = location.fits.front().probability >= config.clear_probability
                         ? StreetVerdict::kLocated
                         : StreetVerdict::kAmbiguous;
  return location;
}

StreetSearch search_along(const StreetGraph& graph, std::span<const Pose2> way,
                          const std::optional<StartArea>& start, double most_m,
                          const StreetLocalizationConfig& config) {
  constexpr double kStep_m = 50.0;
  StreetSearch search;
  std::optional<Pose2> before;
  for (double way_m = config.least_way_m; way_m <= most_m; way_m += kStep_m) {
    const auto driven = way.first(poses_within(way, way_m));
    search.location = locate(graph, driven, start, config);
    const bool is_located = search.location.verdict == StreetVerdict::kLocated;
    if (is_located && before &&
        are_one_place(*before, search.location.fits.front().streets_from_map,
                      {driven.front(), driven[driven.size() / 2], driven.back()})) {
      search.located_after_m = search.location.way_m;
      return search;
    }
    before =
        is_located ? std::optional(search.location.fits.front().streets_from_map) : std::nullopt;
    if (driven.size() == way.size()) break;
  }
  return search;
}

}  // namespace slammot::streets
