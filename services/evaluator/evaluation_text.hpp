#pragma once

#include <string>

#include "services/evaluator/evaluation.hpp"

namespace slammot::evaluator {

/// The table for the terminal.
std::string to_text(const Evaluation& evaluation, const EvaluationOptions& options);

/// evaluation.json: every figure of the table and more, SI units in the names. The same for the
/// same input.
std::string to_json_text(const Evaluation& evaluation, const EvaluationOptions& options);

}  // namespace slammot::evaluator
