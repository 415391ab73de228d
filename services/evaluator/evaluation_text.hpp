#pragma once

#include <string>

#include "services/evaluator/evaluation.hpp"

namespace slammot::evaluator {

/// Table for the terminal.
std::string to_text(const Evaluation& evaluation, const EvaluationOptions& options);

/// Content of evaluation.json: all figures of the table and more, with SI units in the names.
/// Reproducible.
std::string to_json_text(const Evaluation& evaluation, const EvaluationOptions& options);

}  // namespace slammot::evaluator
