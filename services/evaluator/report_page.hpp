#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/evaluator/evaluation.hpp"

namespace slammot::evaluator {

/// What a page is made of. Pointers are not null but where the comment says so.
struct ReportSource {
  std::string title;
  const RunResult* result = nullptr;
  std::string report_json;       ///< Text of report.json; may be empty.
  std::string map_png;           ///< Bytes of map.png; may be empty.
  const Truth* truth = nullptr;  ///< Null where there is none, as is evaluation.
  const Evaluation* evaluation = nullptr;
  std::vector<std::uint32_t> track_ids;  ///< To be shown one by one; chosen where empty.
};

/// One page of HTML that needs nothing else: pictures are inside.
std::string to_html(const ReportSource& source);

/// Tracks worth looking at: of each class the two that were followed longest, and the two that
/// stopped and went on most often.
std::vector<std::uint32_t> choose_tracks(const RunResult& result);

/// Bytes in the alphabet of RFC 4648.
std::string to_base64(const std::string& bytes);

}  // namespace slammot::evaluator
