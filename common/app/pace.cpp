#include "common/app/pace.hpp"

#include <charconv>

namespace slammot::app {
namespace {

constexpr std::int64_t kLongestGapNs = 60'000'000'000;
constexpr double kSlowest = 0.01;
constexpr double kFastest = 1000.0;

}  // namespace

std::optional<Pace> Pace::parse(const std::string& text) {
  if (text == "max") return Pace(std::nullopt);
  double speed = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), speed);
  const bool is_number = fault == std::errc{} && end == text.data() + text.size();
  if (!is_number || !(speed >= kSlowest && speed <= kFastest)) return std::nullopt;
  return Pace(speed);
}

Pace::Time Pace::due(std::int64_t stamp_ns, Time now) {
  const bool leaps = stamp_ns < last_stamp_ns_ || stamp_ns - last_stamp_ns_ > kLongestGapNs;
  if (!start_ || leaps) start_ = Start{stamp_ns, now};
  last_stamp_ns_ = stamp_ns;
  const double since_start_ns =
      static_cast<double>(stamp_ns - start_->stamp_ns) / speed_.value_or(1.0);
  return start_->time + std::chrono::nanoseconds(static_cast<std::int64_t>(since_start_ns));
}

}  // namespace slammot::app
