#pragma once

#include <cstdint>
#include <string>

namespace slammot::files {

/// Seconds with six decimals, as logs and truth files write them; nine where the stamp is finer
/// than a microsecond.
std::string stamp_text(std::int64_t stamp_ns);
void append_stamp(std::string& text, std::int64_t stamp_ns);

/// The number with a fixed count of decimals, never "-0.000".
std::string fixed_text(double value, int decimals);
void append_fixed(std::string& text, double value, int decimals);

/// At most five significant digits, as printf's %.5g: for values over many powers of ten.
std::string short_text(double value);
void append_short(std::string& text, double value);

}  // namespace slammot::files
