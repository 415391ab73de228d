#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace slammot::app {

/// From now on spdlog and the DDS library write to stderr, each line with time, service and level. The level is taken from
/// the environment's SPDLOG_LEVEL.
void set_up_log(std::string_view service_name);

/// Lets one line of a kind through every few seconds, so that a flood of bad input cannot become a flood of lines.
class RateLimit {
 public:
  static constexpr std::chrono::seconds kPeriod{5};

  /// The line to write now, with the number of lines of its kind held back before; empty when it is to be held back.
  std::string pass(const std::string& kind, std::string_view line, std::chrono::steady_clock::time_point now);

 private:
  struct Kind {
    std::chrono::steady_clock::time_point last;
    std::uint64_t held_back = 0;
  };
  std::map<std::string, Kind> kinds_;
};

}  // namespace slammot::app
