#include "common/files/decimal.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace slammot::files {
namespace {

constexpr std::array<double, 17> kPowerOfTen{
    1e0, 1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7, 1e8,
    1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16};  // all exact
constexpr int kSignificant = 5;

/// Nearest integer to a product or quotient of a double and an exact power of ten, with an error of
/// at most half a unit in the last place. None if that is ambiguous (a tie), or if the value is
/// very large.
std::optional<std::int64_t> nearest(double scaled) {
  constexpr double kMost = 1e15;
  if (!(scaled >= 0.0 && scaled < kMost)) return std::nullopt;
  const auto below = static_cast<std::int64_t>(scaled);
  const double beyond = scaled - static_cast<double>(below);
  if (std::abs(beyond - 0.5) <= scaled * std::numeric_limits<double>::epsilon())
    return std::nullopt;
  return below + (beyond > 0.5 ? 1 : 0);
}

void append(std::string& text, std::int64_t number) {
  std::array<char, 24> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

/// Pads with leading zeros to this number of digits.
void append_padded(std::string& text, std::int64_t number, int digits) {
  text.append(static_cast<std::size_t>(digits), '0');
  char* place = text.data() + text.size();
  for (; number > 0; number /= 10) *--place = static_cast<char>('0' + number % 10);
}

std::string by_standard_library(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // the largest double has 309 digits
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), value, format, precision).ptr};
}

/// Leading digits of a nonzero number, as d.dddd times 10 to the exponent.
struct FirstDigits {
  std::int64_t digits = 0;
  int exponent = 0;
};

std::optional<FirstDigits> first_digits(double size) {
  constexpr double kLeast = 1e-12;
  constexpr double kMost = 1e12;
  if (!(size >= kLeast && size < kMost)) return std::nullopt;
  const bool is_whole = size >= 1.0;
  const double scaled_up = is_whole ? size : size * kPowerOfTen[12];
  const auto above = std::upper_bound(kPowerOfTen.begin(), kPowerOfTen.end(), scaled_up);
  const int exponent = static_cast<int>(above - kPowerOfTen.begin()) - 1 - (is_whole ? 0 : 12);
  const int shift = kSignificant - 1 - exponent;
  const auto digits = nearest(shift >= 0 ? size * kPowerOfTen[static_cast<std::size_t>(shift)]
                                         : size / kPowerOfTen[static_cast<std::size_t>(-shift)]);
  constexpr std::int64_t kFewest = 10'000;
  if (!digits || *digits < kFewest) return std::nullopt;
  return *digits == 10 * kFewest ? FirstDigits{kFewest, exponent + 1}
                                 : FirstDigits{*digits, exponent};
}

}  // namespace

void append_stamp(std::string& text, std::int64_t stamp_ns) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  const std::int64_t fraction_ns = std::abs(stamp_ns % kNanosecondsPerSecond);
  if (stamp_ns < 0) text += '-';
  append(text, std::abs(stamp_ns / kNanosecondsPerSecond));
  text += '.';
  if (fraction_ns % 1000 == 0) append_padded(text, fraction_ns / 1000, 6);
  else append_padded(text, fraction_ns, 9);
}

void append_fixed(std::string& text, double value, int decimals) {
  const bool is_short = decimals >= 0 && decimals < static_cast<int>(kPowerOfTen.size());
  const auto parts =
      is_short ? nearest(std::abs(value) * kPowerOfTen[static_cast<std::size_t>(decimals)])
               : std::nullopt;
  if (!parts) {
    const std::string number = by_standard_library(value, std::chars_format::fixed, decimals);
    const bool is_zero = number.find_first_not_of("-0.") == std::string::npos;
    text.append(number, is_zero && number.front() == '-' ? 1 : 0);
    return;
  }
  const auto per_whole = static_cast<std::int64_t>(kPowerOfTen[static_cast<std::size_t>(decimals)]);
  if (value < 0.0 && *parts > 0) text += '-';
  append(text, *parts / per_whole);
  if (decimals == 0) return;
  text += '.';
  append_padded(text, *parts % per_whole, decimals);
}

void append_short(std::string& text, double value) {
  const auto first = first_digits(std::abs(value));
  if (!first) {
    text += by_standard_library(value, std::chars_format::general, kSignificant);
    return;
  }
  std::string digits = std::to_string(first->digits);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (value < 0.0) text += '-';
  const int exponent = first->exponent;
  if (exponent < -4 || exponent >= kSignificant) {
    text += digits.front();
    if (digits.size() > 1) text.append(1, '.').append(digits, 1);
    text += exponent < 0 ? "e-" : "e+";
    append_padded(text, std::abs(exponent), 2);
    return;
  }
  const auto whole_digits = static_cast<std::size_t>(std::max(0, exponent + 1));
  if (exponent < 0)
    text.append("0.").append(static_cast<std::size_t>(-1 - exponent), '0').append(digits);
  else if (digits.size() <= whole_digits)
    text.append(digits).append(whole_digits - digits.size(), '0');
  else text.append(digits, 0, whole_digits).append(1, '.').append(digits, whole_digits);
}

std::string stamp_text(std::int64_t stamp_ns) {
  std::string text;
  append_stamp(text, stamp_ns);
  return text;
}

std::string fixed_text(double value, int decimals) {
  std::string text;
  append_fixed(text, value, decimals);
  return text;
}

std::string short_text(double value) {
  std::string text;
  append_short(text, value);
  return text;
}

}  // namespace slammot::files
