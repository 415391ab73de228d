#pragma once

#include <filesystem>
#include <optional>

#include "services/evaluator/evaluation.hpp"

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// What eval and report are asked for alike.
struct ComparisonOptions {
  std::filesystem::path result;
  std::filesystem::path truth;  ///< Prefix; empty for none, where that is allowed.
  std::filesystem::path input;  ///< Log; empty for the one beside the truth, if any.
  EvaluationOptions evaluation;
};

enum class TruthIs { kRequired, kOptional };

void add_comparison_options(CLI::App& command, ComparisonOptions& options, TruthIs truth);

/// The log asked for, or PREFIX.log beside the truth, if there is any.
std::optional<std::filesystem::path> log_of(const ComparisonOptions& options);

/// Echoes of the log asked for, or of PREFIX.log beside the truth; empty where there is none.
/// result and truth must outlive it.
EchoSource echo_source(const ComparisonOptions& options, const RunResult& result,
                       const Truth& truth);

}  // namespace slammot::evaluator
