#include "services/evaluator/model_truth.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "services/evaluator/hit_runs.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using std::filesystem::path;

constexpr std::size_t kMostModelBeams = 8192;

std::optional<long> number(std::string_view text) {
  long value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

files::Result<std::vector<ClassedWall>> read_classed_walls(const path& prefix) {
  const auto file = plain_or_gz(with_ending(prefix, ".walls.csv"));
  if (!file) return Error{prefix.string() + ".walls.csv: missing"};
  std::vector<ClassedWall> walls;
  const auto fault =
      read_csv(*file, {"ax", "ay", "bx", "by", "class"}, [&](auto fields) -> RowFault {
        const auto row = numbers(fields);
        if (!row) return "a field is not a number";
        walls.push_back(
            {{(*row)[0], (*row)[1]}, {(*row)[2], (*row)[3]}, static_cast<int>((*row)[4])});
        return std::nullopt;
      });
  if (fault) return *fault;
  return walls;
}

files::Result<HitsByScanner> read_hits_of_movers(const path& prefix) {
  HitsByScanner hits;
  const auto file = plain_or_gz(with_ending(prefix, ".hits.csv"));
  if (!file) return hits;
  const auto fault =
      read_csv(*file, {"timestamp", "scanner", "hits"}, [&](auto fields) -> RowFault {
        const auto stamp = numbers(fields.first(1));
        if (!stamp) return "the timestamp is not a number";
        HitsOfMovers beams;
        RowFault malformed = parse_hit_runs(fields[2], kMostModelBeams, [&](const HitRun& run) {
          const auto hit = number(run.hit);  // an object's id is above 0
          if (hit) beams.insert(beams.end(), run.beams, *hit > 0 ? 1 : 0);
          return hit.has_value();
        });
        if (!malformed)
          hits[std::string(fields[1])][std::llround(1e6 * stamp->front())] = std::move(beams);
        return malformed;
      });
  if (fault) return *fault;
  return hits;
}

}  // namespace slammot::evaluator
