#pragma once

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <CLI/CLI.hpp>

namespace slammot::files {

/// Check of an option that takes numbers from `least` to `most`. Unlike CLI11's ranges it refuses
/// NaN and infinity, and negative numbers for unsigned ones. What is no number at all is left to
/// the conversion. `expected`: for the message, "a number, 0 or more"; `name`: for the help.
inline CLI::Validator number_option(double least, double most, const std::string& expected,
                                    const std::string& name = {}) {
  const auto fault_of = [least, most, expected](const std::string& text) -> std::string {
    double number = 0.0;
    const bool is_number = CLI::detail::lexical_cast(text, number);
    if (!is_number || (std::isfinite(number) && number >= least && number <= most)) return {};
    return "'" + text + "' is not " + expected;
  };
  return CLI::Validator(fault_of, name);
}

inline CLI::Validator number_between(double least, double most) {
  char range[64];
  std::snprintf(range, sizeof range, "from %g to %g", least, most);
  return number_option(least, most, "a number " + std::string(range), range);
}

inline CLI::Validator any_number() {
  using Limits = std::numeric_limits<double>;
  return number_option(Limits::lowest(), Limits::max(), "a finite number");
}

inline CLI::Validator not_negative_number() {
  return number_option(0.0, std::numeric_limits<double>::max(), "a number, 0 or more",
                       "NONNEGATIVE");
}

inline CLI::Validator positive_number() {
  using Limits = std::numeric_limits<double>;
  return number_option(Limits::min(), Limits::max(), "a number above 0", "POSITIVE");
}

/// Seconds that nanoseconds in 64 bits can hold together with a stamp.
inline CLI::Validator seconds_option() {
  return number_option(0.0, 1e9, "a number of seconds, 0 or more and at most 1e9", "NONNEGATIVE");
}

}  // namespace slammot::files
