#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <fmt/core.h>

namespace slammot::app {

/// Makes spdlog and the DDS library write to stderr, each line with time, service and level. The
/// level is SPDLOG_LEVEL of the environment.
void set_up_log(std::string_view service_name);

enum class LogLevel { kInfo, kWarning, kError, kCritical };

void log_line(LogLevel level, std::string_view line);

/// One line each, formatted by fmt. Sources that log do not include spdlog, which took most of the
/// time of their compilation.
template <typename... Values>
void log_info(fmt::format_string<Values...> format, Values&&... values) {
  log_line(LogLevel::kInfo, fmt::vformat(format, fmt::make_format_args(values...)));
}

template <typename... Values>
void log_warn(fmt::format_string<Values...> format, Values&&... values) {
  log_line(LogLevel::kWarning, fmt::vformat(format, fmt::make_format_args(values...)));
}

template <typename... Values>
void log_error(fmt::format_string<Values...> format, Values&&... values) {
  log_line(LogLevel::kError, fmt::vformat(format, fmt::make_format_args(values...)));
}

template <typename... Values>
void log_critical(fmt::format_string<Values...> format, Values&&... values) {
  log_line(LogLevel::kCritical, fmt::vformat(format, fmt::make_format_args(values...)));
}

/// Limits each kind of line to one every few seconds, so that a flood of bad input does not flood
/// the log.
class RateLimit {
 public:
  static constexpr std::chrono::seconds kPeriod{5};

  /// The line to write now, with the number of suppressed lines of its kind; empty if it is
  /// suppressed.
  std::string pass(const std::string& kind, std::string_view line,
                   std::chrono::steady_clock::time_point now);

 private:
  struct Kind {
    std::chrono::steady_clock::time_point last;
    std::uint64_t held_back = 0;
  };
  std::map<std::string, Kind> kinds_;
};

}  // namespace slammot::app
