#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/evaluator/evaluation.hpp"

namespace slammot::evaluator {

/// Content of a page. Pointers are not null unless stated.
struct ReportSource {
  std::string title;
  const RunResult* result = nullptr;
  const Truth* truth = nullptr;  ///< May be null, like evaluation.
  const Evaluation* evaluation = nullptr;
  std::vector<std::uint32_t> track_ids;  ///< Tracks to show in detail; empty: chosen by
                                         ///< choose_tracks().
};

/// A self-contained HTML page.
std::string to_html(const ReportSource& source);

/// Tracks for the detailed figures: of each class the two with the longest life, and the two with
/// the most stops.
std::vector<std::uint32_t> choose_tracks(const RunResult& result);

}  // namespace slammot::evaluator
