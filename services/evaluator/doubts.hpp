#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// A time in which the pose deserves less trust than in the rest of the drive.
struct Doubt {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::string what;  ///< In words.
};

/// The time before a drive was located in the stored map that it continues: its online poses are in
/// another frame. None if it was at once, or continues none.
std::optional<Doubt> time_before_located(const RunResult& result);

/// Times before a drive was located in a stored map, when scans did not match the map, when none
/// was localized for a second, and when the published standard deviation of the position was above
/// 0.1 m and four times its median over the drive. Ascending.
std::vector<Doubt> find_doubts(const RunResult& result);

}  // namespace slammot::evaluator
