#include "common/metrics/prediction_errors.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <unordered_map>

#include <Eigen/Cholesky>

#include "common/metrics/chi_square.hpp"

namespace slammot::metrics {
namespace {

using geometry::Vector2;

constexpr std::int64_t kLongestGapNs = 200'000'000;  // between two true places

struct Place {
  std::int64_t stamp_ns = 0;
  Vector2 position_in_world_m = Vector2::Zero();
};

using PlacesOfObject = std::unordered_map<std::size_t, std::vector<Place>>;

PlacesOfObject places_of_objects(const std::vector<Scene>& scenes) {
  PlacesOfObject places;
  for (const Scene& scene : scenes) {
    for (const TrueObject& object : scene.objects)
      places[object.object].push_back({scene.stamp_ns, object.world_from_object.translation_m()});
  }
  return places;
}

std::optional<Vector2> place_at(const std::vector<Place>& places, std::int64_t stamp_ns) {
  const auto after = std::lower_bound(
      places.begin(), places.end(), stamp_ns,
      [](const Place& place, std::int64_t stamp) { return place.stamp_ns < stamp; });
  if (after == places.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->position_in_world_m;
  if (after == places.begin() || after->stamp_ns - std::prev(after)->stamp_ns > kLongestGapNs)
    return std::nullopt;
  const Place& before = *std::prev(after);
  const double share = static_cast<double>(stamp_ns - before.stamp_ns) /
                       static_cast<double>(after->stamp_ns - before.stamp_ns);
  return before.position_in_world_m +
         share * (after->position_in_world_m - before.position_in_world_m);
}

struct PredictionLists {
  std::vector<double> displacement_m, nees;
  std::unordered_map<std::size_t, std::int64_t> last_nees_ns;  // of each object
};

void add(const PredictedPlace& predicted, const Vector2& true_position_m, std::size_t object,
         std::int64_t stamp_ns, PredictionLists& lists) {
  const Vector2 error_m = predicted.position_m - true_position_m;
  lists.displacement_m.push_back(error_m.norm());
  const auto [last, is_first] = lists.last_nees_ns.try_emplace(object, stamp_ns);
  if (!is_first && stamp_ns - last->second < kNeesIntervalNs) return;
  last->second = stamp_ns;
  lists.nees.push_back(error_m.dot(predicted.covariance_m2.ldlt().solve(error_m)));
}

PredictionErrors summarize_lists(double after_s, const PredictionLists& lists) {
  constexpr double kShare = 0.95;
  const double farthest = chi_square_quantile(kShare, 2.0);
  const auto inside = std::count_if(lists.nees.begin(), lists.nees.end(),
                                    [&](double nees) { return nees <= farthest; });
  const double share = lists.nees.empty()
                           ? 0.0
                           : static_cast<double>(inside) / static_cast<double>(lists.nees.size());
  return {after_s, summarize(lists.displacement_m), summarize_nees(lists.nees, 2), share};
}

}  // namespace

std::vector<PredictionErrors> prediction_errors(const std::vector<Scene>& scenes,
                                                const std::vector<CountedScene>& counted,
                                                const std::vector<std::vector<Match>>& matches) {
  const PlacesOfObject places = places_of_objects(scenes);
  std::map<double, PredictionLists> by_time;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const auto& [row, column] : matches[i]) {
      const std::size_t object = scenes[i].objects[counted[i].objects[row]].object;
      for (const PredictedPlace& predicted :
           scenes[i].tracks[counted[i].tracks[column]].predicted) {
        const std::int64_t then_ns =
            scenes[i].stamp_ns + static_cast<std::int64_t>(predicted.after_s * 1e9);
        const auto truth_m = place_at(places.at(object), then_ns);
        if (truth_m)
          add(predicted, *truth_m, object, scenes[i].stamp_ns, by_time[predicted.after_s]);
      }
    }
  }
  std::vector<PredictionErrors> errors;
  for (const auto& [after_s, lists] : by_time) errors.push_back(summarize_lists(after_s, lists));
  return errors;
}

}  // namespace slammot::metrics
