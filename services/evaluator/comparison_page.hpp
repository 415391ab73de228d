#pragma once

#include <string>

#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

struct NamedResult {
  std::string name;
  const RunResult* result = nullptr;  ///< Not null.
};

/// A self-contained HTML page with two results side by side: their players, which show the same
/// moment from the same place, their figures, and the distance between their trajectories.
std::string comparison_page(const NamedResult& a, const NamedResult& b);

}  // namespace slammot::evaluator
