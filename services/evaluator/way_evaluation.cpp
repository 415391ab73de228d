#include "services/evaluator/way_evaluation.hpp"

#include <map>

#include "services/evaluator/stamps.hpp"

namespace slammot::evaluator {
namespace {

constexpr double kLeastStepM = 0.25;  // shorter steps have no direction
constexpr std::int64_t kLongestStepNs = 1'000'000'000;

traffic::Mover mover_of(const std::string& object_class) {
  if (object_class == "pedestrian") return traffic::Mover::kPedestrian;
  return object_class == "bicycle" ? traffic::Mover::kBicycle : traffic::Mover::kVehicle;
}

struct LastPlace {
  std::int64_t stamp_ns = 0;  ///< Last seen.
  geometry::Vector2 position_m = geometry::Vector2::Zero();
};

}  // namespace

std::vector<traffic::TrueStep> true_steps(const std::vector<metrics::Scene>& scenes,
                                          const geometry::Pose2& map_from_world,
                                          const metrics::CountingRule& rule) {
  std::vector<traffic::TrueStep> steps;
  std::map<std::size_t, LastPlace> last;
  for (const metrics::Scene& scene : scenes) {
    const auto add = [&](const metrics::TrueObject& object) {
      const geometry::Vector2 position_m =
          map_from_world * object.world_from_object.translation_m();
      const auto [known, is_new] =
          last.try_emplace(object.object, LastPlace{scene.stamp_ns, position_m});
      LastPlace& before = known->second;
      if (scene.stamp_ns - before.stamp_ns > kLongestStepNs) before.position_m = position_m;
      before.stamp_ns = scene.stamp_ns;
      if (is_new || (position_m - before.position_m).norm() < kLeastStepM) return;
      steps.push_back({mover_of(object.object_class), before.position_m, position_m,
                       metrics::does_count(object, scene, rule)});
      before.position_m = position_m;
    };
    for (const metrics::TrueObject& object : scene.objects) add(object);
    for (const metrics::TrueObject& object : scene.hidden_objects) add(object);
  }
  return steps;
}

WayEvaluation evaluate_ways(const std::vector<traffic::Way>& ways,
                            const std::vector<traffic::TrueStep>& steps) {
  WayEvaluation evaluation;
  traffic::WayRule rule;
  evaluation.all = traffic::judge(ways, steps, rule);
  rule.least_confidence = evaluation.least_confidence;
  evaluation.confident = traffic::judge(ways, steps, rule);
  return evaluation;
}

const char* name_of(traffic::Mover mover) {
  switch (mover) {
    case traffic::Mover::kVehicle: return "lane";
    case traffic::Mover::kBicycle: return "cycle_lane";
    case traffic::Mover::kPedestrian: return "walkway";
  }
  return "";
}

}  // namespace slammot::evaluator
