#include "common/files/decimal.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace slammot::files {

std::string stamp_text(std::int64_t stamp_ns) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  const long long seconds = std::llabs(stamp_ns / kNanosecondsPerSecond);
  const long long fraction_ns = std::llabs(stamp_ns % kNanosecondsPerSecond);
  const char* const sign = stamp_ns < 0 ? "-" : "";
  char text[40];
  if (fraction_ns % 1000 == 0) {
    std::snprintf(text, sizeof text, "%s%lld.%06lld", sign, seconds, fraction_ns / 1000);
  } else {
    std::snprintf(text, sizeof text, "%s%lld.%09lld", sign, seconds, fraction_ns);
  }
  return text;
}

std::string fixed_text(double value, int decimals) {
  char text[400];  // the largest double has 309 digits
  const auto written = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  std::string number(text, written.ptr);
  const bool is_zero = number.find_first_not_of("-0.") == std::string::npos;
  return is_zero && number.front() == '-' ? number.substr(1) : number;
}

}  // namespace slammot::files
