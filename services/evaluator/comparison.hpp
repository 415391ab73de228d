#pragma once

#include <filesystem>
#include <optional>

#include "services/evaluator/evaluation.hpp"

namespace CLI {
class App;
}

namespace slammot::evaluator {

/// Options of both eval and report.
struct ComparisonOptions {
  std::filesystem::path result;
  std::filesystem::path truth;  ///< Prefix of the files; empty for none, where that is allowed.
  std::filesystem::path input;  ///< Log; empty for the one beside the truth, if any.
  EvaluationOptions evaluation;
};

enum class TruthIs { kRequired, kOptional };

void add_comparison_options(CLI::App& command, ComparisonOptions& options, TruthIs truth);

/// The given log, or PREFIX.log beside the truth if it exists.
std::optional<std::filesystem::path> log_of(const ComparisonOptions& options);

/// Echoes of the given log, or of PREFIX.log beside the truth; empty if there is none. `result` and
/// `truth` must outlive it.
EchoSource echo_source(const ComparisonOptions& options, const RunResult& result,
                       const Truth& truth);

}  // namespace slammot::evaluator
