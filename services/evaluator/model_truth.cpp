#include "services/evaluator/model_truth.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using std::filesystem::path;

constexpr std::size_t kMostBeams = 8192;

path with_ending(const path& prefix, const char* ending) { return prefix.string() + ending; }

std::optional<long> number(std::string_view text) {
  long value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Runs "HIT*BEAMS", from the first beam on; an object's id is above 0.
std::optional<HitsOfMovers> parse_hits(std::string_view rest) {
  HitsOfMovers hits;
  while (!rest.empty()) {
    const std::string_view run = rest.substr(0, rest.find(' '));
    const std::size_t star = run.find('*');
    if (star == std::string_view::npos) return std::nullopt;
    const auto hit = number(run.substr(0, star));
    const auto beams = number(run.substr(star + 1));
    if (!hit || !beams || *beams < 1 || static_cast<std::size_t>(*beams) > kMostBeams - hits.size())
      return std::nullopt;
    hits.insert(hits.end(), static_cast<std::size_t>(*beams), *hit > 0 ? 1 : 0);
    rest.remove_prefix(std::min(run.size() + 1, rest.size()));
  }
  return hits;
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
        auto beams = parse_hits(fields[2]);
        if (!stamp || !beams) return "no stamp, or not runs of hits";
        hits[std::string(fields[1])][std::llround(1e6 * stamp->front())] = std::move(*beams);
        return std::nullopt;
      });
  if (fault) return *fault;
  return hits;
}

}  // namespace slammot::evaluator
