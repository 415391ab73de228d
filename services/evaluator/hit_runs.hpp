#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {

/// Successive beams of a scan with the same hit: "HIT*BEAMS" in hits.csv, HIT being -2, -1, 0 or
/// the id of an object.
struct HitRun {
  std::string_view hit;
  std::size_t beams = 0;
};

/// Passes the runs, with blanks between them, to `take` from the first beam on; it returns false
/// for a hit that it does not know. Fails at the first malformed or unknown run, and beyond
/// `most_beams`.
RowFault parse_hit_runs(std::string_view text, std::size_t most_beams,
                        const std::function<bool(const HitRun&)>& take);

}  // namespace slammot::evaluator
