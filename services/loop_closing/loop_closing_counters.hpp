#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace slammot::loop_closing {

/// Counts since the start.
struct LoopClosingCounters {
  std::uint64_t submaps = 0;
  std::uint64_t repeated_submaps = 0;  ///< Id already known: ignored.
  std::uint64_t faulty_submaps = 0;    ///< With NaN or infinite values: ignored.
  std::uint64_t searches = 0;
  std::uint64_t searches_given_up = 0;  ///< Budget exceeded, or displaced by newer searches.
  std::uint64_t search_work = 0;        ///< Cells read.
  std::uint64_t hypotheses = 0;         ///< Searches with a match.
  std::uint64_t ambiguous = 0;          ///< Of these, with competing poses.
  std::uint64_t inconsistent = 0;    ///< With enough support but contradicting the graph: rejected.
  std::uint64_t closures = 0;        ///< Accepted, including those withdrawn later.
  std::uint64_t withdrawn = 0;       ///< Accepted closures that were withdrawn.
  std::uint64_t came_back = 0;       ///< Rejected or withdrawn closures that were accepted again.
  std::uint64_t contradictions = 0;  ///< Submaps whose walls disagree with the map at the pose that
                                     ///< the graph gives them.
  std::uint64_t found_elsewhere = 0;  ///< Closures that joined two islands.
  std::uint64_t superseded = 0;  ///< Submaps that are no target any more: others show the same.
  std::uint64_t optimisations = 0;
};

/// Counters by member name, for reports and status messages.
inline std::map<std::string, std::uint64_t> named(const LoopClosingCounters& counters) {
  return {{"submaps", counters.submaps},
          {"repeated_submaps", counters.repeated_submaps},
          {"faulty_submaps", counters.faulty_submaps},
          {"searches", counters.searches},
          {"searches_given_up", counters.searches_given_up},
          {"search_work", counters.search_work},
          {"hypotheses", counters.hypotheses},
          {"ambiguous", counters.ambiguous},
          {"inconsistent", counters.inconsistent},
          {"closures", counters.closures},
          {"withdrawn", counters.withdrawn},
          {"came_back", counters.came_back},
          {"contradictions", counters.contradictions},
          {"found_elsewhere", counters.found_elsewhere},
          {"superseded", counters.superseded},
          {"optimisations", counters.optimisations}};
}

}  // namespace slammot::loop_closing
