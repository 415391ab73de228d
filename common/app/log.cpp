#include "common/app/log.hpp"

#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/dds/log.hpp"

namespace slammot::app {
namespace {

spdlog::level::level_enum level_of(dds::LogLevel level) {
  if (level == dds::LogLevel::kError) return spdlog::level::err;
  return level == dds::LogLevel::kWarning ? spdlog::level::warn : spdlog::level::info;
}

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kInfo: return spdlog::level::info;
    case LogLevel::kWarning: return spdlog::level::warn;
    case LogLevel::kError: return spdlog::level::err;
    case LogLevel::kCritical: return spdlog::level::critical;
  }
  return spdlog::level::info;
}

}  // namespace

void log_line(LogLevel level, std::string_view line) {
  spdlog::default_logger_raw()->log(level_of(level), line);
}

void set_up_log(std::string_view service_name) {
  const std::string name(service_name);
  spdlog::drop(name);
  spdlog::set_default_logger(spdlog::stderr_color_mt(name));
  spdlog::set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  spdlog::cfg::load_env_levels();
  dds::set_log_handler([](dds::LogLevel level, std::string_view line) {
    spdlog::log(level_of(level), "dds: {}", line);
  });
}

std::string RateLimit::pass(const std::string& kind, std::string_view line,
                            std::chrono::steady_clock::time_point now) {
  const auto [known, is_new] = kinds_.try_emplace(kind, Kind{now, 0});
  Kind& state = known->second;
  if (!is_new && now - state.last < kPeriod) {
    ++state.held_back;
    return {};
  }
  std::string text(line);
  if (state.held_back > 0) text += " (and " + std::to_string(state.held_back) + " more like it)";
  state = {now, 0};
  return text;
}

}  // namespace slammot::app
