#include "services/evaluator/truth_files.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using files::Result;
using std::filesystem::path;

constexpr double kLongestWallM = 1e5;

path with_ending(const path& prefix, const char* ending) { return prefix.string() + ending; }

void sort_by_stamp(metrics::Trajectory& trajectory) {
  std::stable_sort(trajectory.begin(), trajectory.end(), [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; });
}

Result<metrics::Trajectory> read_reference(const path& file) {
  metrics::Trajectory trajectory;
  const auto fault = read_fields(file, 5, [&](auto fields) -> RowFault {
    const auto row = numbers(fields.first(5));
    if (!row) return "a field is no number";
    trajectory.push_back({to_ns((*row)[1]), {(*row)[2], (*row)[3], (*row)[4]}});
    return std::nullopt;
  });
  if (fault) return *fault;
  if (trajectory.empty()) return Error{file.string() + ": no poses"};
  sort_by_stamp(trajectory);
  return trajectory;
}

/// Fills truth.objects and truth.object_count.
std::optional<Error> read_objects(const path& file, Truth& truth) {
  std::map<std::int64_t, std::vector<metrics::TrueObject>> by_stamp;
  std::unordered_map<std::string, std::size_t> index_of_id;
  const auto fault = read_csv(file, {"timestamp", "x", "y", "yaw", "speed", "length", "width", "points", "id", "class"}, [&](auto fields) -> RowFault {
    const auto row = numbers(fields.first(8));
    if (!row) return "a field is no number";
    const auto& v = *row;
    metrics::TrueObject object;
    object.object = index_of_id.try_emplace(std::string(fields[8]), index_of_id.size()).first->second;
    object.object_class = fields[9];
    object.world_from_object = {v[1], v[2], v[3]};
    object.speed_mps = v[4];
    object.length_m = v[5];
    object.width_m = v[6];
    object.points = static_cast<int>(std::clamp(v[7], 0.0, 1e6));
    by_stamp[to_ns(v[0])].push_back(object);
    return std::nullopt;
  });
  if (fault) return fault;
  truth.object_count = index_of_id.size();
  truth.objects.emplace();
  for (auto& [stamp_ns, objects] : by_stamp) truth.objects->push_back({stamp_ns, std::move(objects)});
  return std::nullopt;
}

std::optional<Error> read_walls(const path& file, Truth& truth) {
  truth.walls.emplace();
  return read_csv(file, {"ax", "ay", "bx", "by"}, [&](auto fields) -> RowFault {
    const auto row = numbers(fields);
    if (!row) return "a field is no number";
    if (std::hypot((*row)[2] - (*row)[0], (*row)[3] - (*row)[1]) > kLongestWallM) return "a wall longer than a city";
    truth.walls->push_back({{(*row)[0], (*row)[1]}, {(*row)[2], (*row)[3]}});
    return std::nullopt;
  });
}

Result<Truth> with_trajectory(Result<metrics::Trajectory> trajectory, const path& file) {
  if (!trajectory) return trajectory.error();
  Truth truth;
  truth.trajectory = std::move(*trajectory);
  truth.read.push_back(file.filename().string());
  return truth;
}

std::optional<Error> add_objects_and_walls(const path& prefix, Truth& truth) {
  if (const auto file = plain_or_gz(with_ending(prefix, ".objects.csv"))) {
    if (auto fault = read_objects(*file, truth)) return fault;
    truth.read.push_back(file->filename().string());
  }
  if (const auto file = plain_or_gz(with_ending(prefix, ".walls.csv"))) {
    if (auto fault = read_walls(*file, truth)) return fault;
    truth.read.push_back(file->filename().string());
  }
  return std::nullopt;
}

}  // namespace

Result<metrics::Trajectory> read_tum(const path& file) {
  metrics::Trajectory trajectory;
  const auto fault = read_fields(file, 8, [&](auto fields) -> RowFault {
    const auto row = numbers(fields.first(8));
    if (!row) return "a field is no number";
    const auto& v = *row;
    const double heading_rad = std::atan2(2.0 * (v[7] * v[6] + v[4] * v[5]), 1.0 - 2.0 * (v[5] * v[5] + v[6] * v[6]));
    trajectory.push_back({to_ns(v[0]), {v[1], v[2], heading_rad}});
    return std::nullopt;
  });
  if (fault) return *fault;
  if (trajectory.empty()) return Error{file.string() + ": no poses"};
  sort_by_stamp(trajectory);
  return trajectory;
}

Result<Truth> read_truth(const path& prefix) {
  if (const auto file = plain_or_gz(with_ending(prefix, ".tum"))) {
    auto truth = with_trajectory(read_tum(*file), *file);
    if (!truth) return truth;
    if (auto fault = add_objects_and_walls(prefix, *truth)) return *fault;
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
  if (const auto file = plain_or_gz(with_ending(prefix, ".reference.txt"))) return with_trajectory(read_reference(*file), *file);
  return Error{prefix.string() + ": no truth here: neither " + prefix.filename().string() + ".tum nor .ego.tum nor .reference.txt, plain or .gz"};
}

}  // namespace slammot::evaluator
