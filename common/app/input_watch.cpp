#include "common/app/input_watch.hpp"

#include <cstdio>

namespace slammot::app {

bool InputWatch::is_missing(SteadyTime now, std::chrono::nanoseconds patience) const {
  return kind_ == Input::kSteady && now - last_.value_or(since_) > patience;
}

double InputWatch::silent_s(SteadyTime now) const {
  return last_ ? std::chrono::duration<double>(now - *last_).count() : -1.0;
}

std::string InputWatch::complaint(SteadyTime now) const {
  if (!last_) return "no " + topic_name_ + " yet";
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.1f", silent_s(now));
  return "no " + topic_name_ + " for " + seconds + " s";
}

}  // namespace slammot::app
