#include "services/evaluator/hit_runs.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>

namespace slammot::evaluator {
namespace {

std::optional<HitRun> parse_run(std::string_view text) {
  const std::size_t star = text.find('*');
  if (star == std::string_view::npos) return std::nullopt;
  HitRun run{text.substr(0, star), 0};
  const auto [end, fault] =
      std::from_chars(text.data() + star + 1, text.data() + text.size(), run.beams);
  if (fault != std::errc() || end != text.data() + text.size() || run.beams == 0)
    return std::nullopt;
  return run;
}

}  // namespace

RowFault parse_hit_runs(std::string_view text, std::size_t most_beams,
                        const std::function<bool(const HitRun&)>& take) {
  std::size_t beams = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const auto run = parse_run(text.substr(0, end));
    const bool is_run = run && run->beams <= most_beams && take(*run);
    if (!is_run)
      return "not a run of hits, or of an object that objects.csv does not have: " +
             std::string(text.substr(0, end));
    if ((beams += run->beams) > most_beams) return "more beams than any scanner has";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::nullopt;
}

}  // namespace slammot::evaluator
