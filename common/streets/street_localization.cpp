#include "common/streets/street_localization.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/streets/street_evidence.hpp"
#include "common/streets/street_field.hpp"
#include "common/streets/street_network.hpp"

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kMargin_m = 60.0;       // around what the way can reach
constexpr std::size_t kExplained = 200;  // places
constexpr std::size_t kMostFits = 20;
constexpr double kImprobable = 10.0;  // costs more than the best place
constexpr double kLeastShare = 0.25;  // of the way on streets
constexpr double kPoorGraph = 1.6;    // the logarithm of one half in place of one tenth
constexpr double kNotPassed_m = 15.0;

bool has_place(const std::optional<StartArea>& start) {
  return start && std::isfinite(start->radius_m);
}

Area area_of(const StreetGraph& graph, const DrivenWay& way,
             const std::optional<StartArea>& start) {
  if (has_place(start)) return {start->centre_m, start->radius_m + way.reach_m() + kMargin_m};
  if (graph.streets.empty()) return {Vector2::Zero(), kMargin_m};
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

/// The streets that come near to an area, whole and in the same order: far ones change nothing, and
/// a graph may be of a whole country.
StreetGraph near(const StreetGraph& graph, const Area& area) {
  constexpr double kBeyond_m = 250.0;  // more than what is seen from a way
  StreetGraph clipped{graph.origin, {}};
  const double reach_m = area.half_side_m + kBeyond_m;
  for (const Street& street : graph.streets) {
    Vector2 low_m = Vector2::Constant(std::numeric_limits<double>::max());
    Vector2 high_m = -low_m;
    for (const Vector2& point_m : street.line_m) {
      low_m = low_m.cwiseMin(point_m);
      high_m = high_m.cwiseMax(point_m);
    }
    if (((low_m - area.centre_m).array() <= reach_m).all() &&
        ((high_m - area.centre_m).array() >= -reach_m).all())
      clipped.streets.push_back(street);
  }
  return clipped;
}

/// Streets around a way.
struct Surroundings {
  Surroundings(const StreetGraph& graph, const DrivenWay& way,
               const std::optional<StartArea>& start)
      : area(area_of(graph, way, start)), network(near(graph, area)), field(network, area) {}

  Area area;
  StreetNetwork network;
  StreetField field;
};

StreetPrior prior_of(const Area& area, const std::optional<StartArea>& start,
                     const StreetLocalizationConfig& config) {
  StreetPrior prior;
  prior.node_sigma_m = config.node_sigma_m;
  prior.lane_sigma_m = config.lane_sigma_m;
  // Standard deviations of even distributions.
  prior.place_sigma_m =
      has_place(start) ? 0.5 * start->radius_m : area.half_side_m / std::numbers::sqrt3;
  prior.heading_sigma_rad =
      (start && start->x_from_east_rad ? start->direction_within_rad : std::numbers::pi) /
      std::numbers::sqrt3;
  return prior;
}

/// Evidence of places, best first. Streets are taken for missing only where that can make a place
/// probable.
std::vector<Explanation> explained(const StreetEvidence& evidence,
                                   const std::vector<Pose2>& places) {
  std::vector<Explanation> explanations;
  for (const Pose2& place : places) explanations.push_back(evidence.explain(place));
  std::ranges::stable_sort(explanations, {}, &Explanation::cost);
  double least = std::numeric_limits<double>::infinity();
  for (Explanation& explanation : explanations) {
    if (explanation.cost - explanation.squares < least + kImprobable)
      explanation = evidence.with_missing_streets(explanation);
    least = std::min(least, explanation.cost);
  }
  std::ranges::stable_sort(explanations, {}, &Explanation::cost);
  return explanations;
}

/// The best places that agree with the start, each once.
std::vector<StreetFit> fits_of(const std::vector<Explanation>& explanations, const DrivenWay& way,
                               const std::optional<StartArea>& start) {
  std::vector<StreetFit> fits;
  for (const Explanation& explanation : explanations) {
    const Pose2& place = explanation.streets_from_map;
    if (explanation.share < kLeastShare) continue;
    const bool is_new = std::ranges::none_of(fits, [&](const StreetFit& known) {
      return are_one_place(known.streets_from_map, place, way);
    });
    if (is_new && fits.size() < kMostFits && agrees_with_start(place, way, start))
      fits.push_back({place, explanation.cost, explanation.share, 0.0, explanation.missing});
  }
  return fits;
}

/// Probabilities beside each other and beside a way that is nowhere on the streets.
void set_probabilities(std::vector<StreetFit>& fits, double cost_beside) {
  double sum = std::exp(fits.front().cost - cost_beside);
  for (const StreetFit& fit : fits) sum += std::exp(fits.front().cost - fit.cost);
  for (StreetFit& fit : fits) fit.probability = std::exp(fits.front().cost - fit.cost) / sum;
}

/// Probability of the best place if half of all streets were missing: how many are is not known,
/// and a place with all its streets must stand against others without some of theirs.
double probability_in_a_poor_graph(const std::vector<StreetFit>& fits, double cost_beside) {
  const StreetFit& best = fits.front();
  double sum = std::exp(best.cost - cost_beside);
  for (const StreetFit& fit : fits)
    sum += std::exp(best.cost - fit.cost + kPoorGraph * (fit.missing - best.missing));
  return 1.0 / sum;
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

/// The part of a way from which its sides are seen: without its last metres.
DrivenWay passed(std::span<const Pose2> way) {
  double travelled_m = 0.0;
  std::size_t count = way.size();
  while (count > 1 && travelled_m < kNotPassed_m) {
    travelled_m += (way[count - 1].translation_m() - way[count - 2].translation_m()).norm();
    --count;
  }
  return driven_way(way.first(count));
}

StreetLocation locate(const Surroundings& streets, const DrivenWay& way,
                      const std::optional<StartArea>& start, const StreetLocalizationConfig& config,
                      std::vector<ViewFan> fans) {
  StreetLocation location;
  location.way_m = way.length_m();
  if (location.way_m < config.least_way_m) return location;
  location.verdict = StreetVerdict::kNotOnStreets;
  const StreetEvidence evidence(streets.network, streets.field, way,
                                prior_of(streets.area, start, config), std::move(fans));
  const std::vector<Pose2> places = proposed_places(streets.field, way, start, kExplained);
  location.fits = fits_of(explained(evidence, places), way, start);
  const double cost_beside = evidence.beside_all_streets().cost;
  if (location.fits.empty() || location.fits.front().cost > cost_beside) return location;
  set_probabilities(location.fits, cost_beside);
  location.verdict =
      std::min(location.fits.front().probability,
               probability_in_a_poor_graph(location.fits, cost_beside)) >= config.clear_probability
          ? StreetVerdict::kLocated
          : StreetVerdict::kAmbiguous;
  return location;
}

}  // namespace

StreetLocation locate(const StreetGraph& graph, std::span<const Pose2> way,
                      const std::optional<StartArea>& start, const StreetLocalizationConfig& config,
                      const SeenSpace& seen) {
  const DrivenWay driven = driven_way(way);
  return locate(Surroundings(graph, driven, start), driven, start, config,
                side_views(seen, passed(way)));
}

StreetSearch search_along(const StreetGraph& graph, std::span<const Pose2> way,
                          const std::optional<StartArea>& start, double most_m,
                          const StreetLocalizationConfig& config, const SeenSpace& seen) {
  constexpr double kStep_m = 50.0;
  StreetSearch search;
  const Surroundings streets(graph, driven_way(way.first(poses_within(way, most_m))), start);
  for (double way_m = config.least_way_m; way_m <= most_m; way_m += kStep_m) {
    const auto driven = way.first(poses_within(way, way_m));
    search.location =
        locate(streets, driven_way(driven), start, config, side_views(seen, passed(driven)));
    if (search.location.verdict == StreetVerdict::kLocated) {
      search.located_after_m = search.location.way_m;
      return search;
    }
    if (driven.size() == way.size()) break;
  }
  return search;
}

}  // namespace slammot::streets
