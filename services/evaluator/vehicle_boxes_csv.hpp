#pragma once

#include <string>

#include "services/evaluator/evaluation.hpp"

namespace slammot::evaluator {

/// The rows that the box errors of vehicles sum up: `ahead_m`, `left_m` and `turned_rad` place the
/// reported box in the frame of the true one. The header only where tracking was not evaluated.
std::string vehicle_boxes_csv(const Evaluation& evaluation);

}  // namespace slammot::evaluator
