#include "services/evaluator/truth_files.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "services/evaluator/hit_runs.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using files::Result;
using std::filesystem::path;

constexpr double kLongestWallM = 1e5;

void sort_by_stamp(metrics::Trajectory& trajectory) {
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; });
}

Result<metrics::Trajectory> read_reference(const path& file) {
  metrics::Trajectory trajectory;
  const auto fault = read_fields(file, 5, [&](auto fields) -> RowFault {
    const auto row = numbers(fields.first(5));
    if (!row) return "a field is not a number";
    trajectory.push_back({to_ns((*row)[1]), {(*row)[2], (*row)[3], (*row)[4]}});
    return std::nullopt;
  });
  if (fault) return *fault;
  if (trajectory.empty()) return Error{file.string() + ": no poses"};
  sort_by_stamp(trajectory);
  return trajectory;
}

using IndexOfId = std::unordered_map<std::string, std::size_t>;

/// Reads objects, their number and the index of each id.
std::optional<Error> read_objects(const path& file, Truth& truth, IndexOfId& index_of_id) {
  std::map<std::int64_t, ObjectsAt> by_stamp;
  const auto fault = read_csv(
      file, {"timestamp", "x", "y", "yaw", "speed", "length", "width", "points", "id", "class"},
      [&](auto fields) -> RowFault {
        const auto row = numbers(fields.first(8));
        if (!row) return "a field is not a number";
        const auto& v = *row;
        metrics::TrueObject object;
        object.object =
            index_of_id.try_emplace(std::string(fields[8]), index_of_id.size()).first->second;
        object.object_class = fields[9];
        object.world_from_object = {v[1], v[2], v[3]};
        object.speed_mps = v[4];
        object.length_m = v[5];
        object.width_m = v[6];
        object.points = static_cast<int>(std::clamp(v[7], 0.0, 1e6));
        ObjectsAt& at = by_stamp[to_ns(v[0])];
        (object.points > 0 ? at.objects : at.hidden).push_back(object);
        return std::nullopt;
      });
  if (fault) return fault;
  truth.object_count = index_of_id.size();
  truth.objects.emplace();
  for (auto& [stamp_ns, at] : by_stamp)
    truth.objects->push_back({stamp_ns, std::move(at.objects), std::move(at.hidden)});
  return std::nullopt;
}

constexpr std::size_t kMostBeams = 100'000;

std::optional<metrics::BeamHit> hit_named(std::string_view hit, const IndexOfId& index_of_id) {
  using On = metrics::BeamHit::On;
  metrics::BeamHit named;
  if (hit == "-1") named.on = On::kNothing;
  else if (hit == "0") named.on = On::kStationary;
  else if (hit == "-2") named.on = On::kSeveral;
  else if (const auto known = index_of_id.find(std::string(hit)); known != index_of_id.end())
    named = {On::kObject, known->second};
  else return std::nullopt;
  return named;
}

std::optional<Error> read_hits(const path& file, const IndexOfId& index_of_id, Truth& truth) {
  truth.hits.emplace();
  std::string scanner;
  const auto fault = read_csv(file, {"timestamp", "scanner", "hits"}, [&](auto fields) -> RowFault {
    if (scanner.empty()) scanner = fields[1];
    if (scanner != fields[1]) return std::nullopt;
    const auto stamp = numbers(fields.first(1));
    if (!stamp) return "the timestamp is not a number";
    HitsAt at{to_ns(stamp->front()), {}};
    RowFault malformed = parse_hit_runs(fields[2], kMostBeams, [&](const HitRun& run) {
      const auto hit = hit_named(run.hit, index_of_id);
      if (hit) at.runs.push_back({*hit, run.beams});
      return hit.has_value();
    });
    if (malformed) return malformed;
    truth.hits->push_back(std::move(at));
    return std::nullopt;
  });
  if (fault) return fault;
  std::ranges::stable_sort(*truth.hits, {}, &HitsAt::stamp_ns);
  return std::nullopt;
}

std::optional<Error> read_walls(const path& file, Truth& truth) {
  truth.walls.emplace();
  return read_csv(file, {"ax", "ay", "bx", "by"}, [&](auto fields) -> RowFault {
    const auto row = numbers(fields);
    if (!row) return "a field is not a number";
    if (std::hypot((*row)[2] - (*row)[0], (*row)[3] - (*row)[1]) > kLongestWallM)
      return "a wall longer than a city";
    truth.walls->push_back({{(*row)[0], (*row)[1]}, {(*row)[2], (*row)[3]}});
    return std::nullopt;
  });
}

Result<Truth> read_people(const path& file) {
  std::map<std::int64_t, std::vector<metrics::TrueObject>> by_stamp;
  IndexOfId index_of_id;
  const auto fault = read_fields(file, 4, [&](auto fields) -> RowFault {
    const auto stamp = numbers(fields.first(1));
    const auto place = numbers(fields.subspan(2, 2));
    if (!stamp || !place) return "a field is not a number";
    metrics::TrueObject person;
    person.object =
        index_of_id.try_emplace(std::string(fields[1]), index_of_id.size()).first->second;
    person.object_class = "pedestrian";
    person.world_from_object = {(*place)[0], (*place)[1], 0.0};
    by_stamp[to_ns(stamp->front())].push_back(person);
    return std::nullopt;
  });
  if (fault) return *fault;
  if (by_stamp.empty()) return Error{file.string() + ": no annotations"};
  Truth truth;
  truth.object_count = index_of_id.size();
  truth.annotated.emplace();
  for (auto& [stamp_ns, people] : by_stamp)
    truth.annotated->push_back({stamp_ns, std::move(people)});
  truth.read.push_back(file.filename().string());
  return truth;
}

Result<Truth> with_trajectory(Result<metrics::Trajectory> trajectory, const path& file) {
  if (!trajectory) return trajectory.error();
  Truth truth;
  truth.trajectory = std::move(*trajectory);
  truth.read.push_back(file.filename().string());
  return truth;
}

std::optional<Error> add_scene(const path& prefix, Truth& truth) {
  IndexOfId index_of_id;
  if (const auto file = plain_or_gz(with_ending(prefix, ".objects.csv"))) {
    if (auto fault = read_objects(*file, truth, index_of_id)) return fault;
    truth.read.push_back(file->filename().string());
  }
  const auto hits = plain_or_gz(with_ending(prefix, ".hits.csv"));
  if (hits && truth.objects) {
    if (auto fault = read_hits(*hits, index_of_id, truth)) return fault;
    truth.read.push_back(hits->filename().string());
  }
  if (const auto file = plain_or_gz(with_ending(prefix, ".walls.csv"))) {
    if (auto fault = read_walls(*file, truth)) return fault;
    truth.read.push_back(file->filename().string());
  }
  return std::nullopt;
}

}  // namespace

std::vector<metrics::BeamHit> HitsAt::hits() const {
  std::vector<metrics::BeamHit> all;
  for (const Run& run : runs) all.insert(all.end(), run.beams, run.hit);
  return all;
}

Result<metrics::Trajectory> read_tum(const path& file) {
  metrics::Trajectory trajectory;
  const auto fault = read_fields(file, 8, [&](auto fields) -> RowFault {
    const auto row = numbers(fields.first(8));
    if (!row) return "a field is not a number";
    const auto& v = *row;
    const double heading_rad =
        std::atan2(2.0 * (v[7] * v[6] + v[4] * v[5]), 1.0 - 2.0 * (v[5] * v[5] + v[6] * v[6]));
    trajectory.push_back({to_ns(v[0]), {v[1], v[2], heading_rad}});
    return std::nullopt;
  });
  if (fault) return *fault;
  if (trajectory.empty()) return Error{file.string() + ": no poses"};
  sort_by_stamp(trajectory);
  return trajectory;
}

Result<Truth> read_truth(const path& prefix) {
  if (const auto file = plain_or_gz(prefix / "people_gt.txt")) return read_people(*file);
  if (const auto file = plain_or_gz(with_ending(prefix, ".tum"))) {
    auto truth = with_trajectory(read_tum(*file), *file);
    if (!truth) return truth;
    if (auto fault = add_scene(prefix, *truth)) return *fault;
    return truth;
  }
  if (const auto file = plain_or_gz(with_ending(prefix, ".ego.tum"))) {
    auto truth = with_trajectory(read_tum(*file), *file);
    const auto other = plain_or_gz(with_ending(prefix, ".red.tum"));
    if (!truth || !other) return truth;
    auto other_car = read_tum(*other);
    if (!other_car) return other_car.error();
    truth->other_car = std::move(*other_car);
    truth->read.push_back(other->filename().string());
    return truth;
  }
  if (const auto file = plain_or_gz(with_ending(prefix, ".reference.txt")))
    return with_trajectory(read_reference(*file), *file);
  return Error{prefix.string() + ": no truth here: neither " + prefix.filename().string() +
               ".tum nor .ego.tum nor .reference.txt, plain or .gz"};
}

}  // namespace slammot::evaluator
