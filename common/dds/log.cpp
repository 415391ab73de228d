#include "common/dds/log.hpp"

#include <iostream>
#include <mutex>
#include <optional>
#include <utility>

#include <dds/dds.h>

namespace slammot::dds {
namespace {

struct Line {
  LogLevel level;
  std::string text;
};

void write_to_stderr(LogLevel, std::string_view line) { std::cerr << line << '\n'; }

// The library has one log sink for the process, so its state is one for the process too. Never
// destroyed: DDS threads may log until the very end.
struct LogState {
  std::mutex mutex;
  LogHandler handler = write_to_stderr;
  std::optional<std::vector<Line>> captured;
  std::mutex one_capture;
};

LogState& log_state() {
  static auto* state = new LogState;
  return *state;
}

LogLevel level_of(std::uint32_t priority) {
  if (priority <= DDS_LC_ERROR) return LogLevel::kError;
  return priority <= DDS_LC_WARNING ? LogLevel::kWarning : LogLevel::kInfo;
}

std::string without_line_end(const dds_log_data_t& data) {
  std::string text(data.message, data.size);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.pop_back();
  return text;
}

void receive(void*, const dds_log_data_t* data) {
  const Line line{level_of(data->priority), without_line_end(*data)};
  LogState& state = log_state();
  std::unique_lock lock(state.mutex);
  if (state.captured) {
    state.captured->push_back(line);
    return;
  }
  const LogHandler handler = state.handler;
  lock.unlock();
  handler(line.level, line.text);
}

void install_sink_once() {
  static const bool installed = [] {
    dds_set_log_sink(receive, nullptr);
    return true;
  }();
  static_cast<void>(installed);
}

}  // namespace

void set_log_handler(LogHandler handler) {
  install_sink_once();
  LogState& state = log_state();
  const std::scoped_lock lock(state.mutex);
  state.handler = std::move(handler);
}

LogCapture::LogCapture() {
  install_sink_once();
  LogState& state = log_state();
  state.one_capture.lock();
  const std::scoped_lock lock(state.mutex);
  state.captured.emplace();
}

LogCapture::~LogCapture() {
  LogState& state = log_state();
  std::vector<Line> lines;
  LogHandler handler;
  {
    const std::scoped_lock lock(state.mutex);
    lines = std::exchange(state.captured, std::nullopt).value();
    handler = state.handler;
  }
  state.one_capture.unlock();
  // Errors go to the caller who captures them; other messages go to the handler.
  for (const Line& line : lines) {
    if (line.level != LogLevel::kError) handler(line.level, line.text);
  }
}

std::string LogCapture::errors() const {
  LogState& state = log_state();
  const std::scoped_lock lock(state.mutex);
  std::string joined;
  for (const Line& line : *state.captured) {
    if (line.level != LogLevel::kError) continue;
    if (!joined.empty()) joined += "; ";
    joined += line.text;
  }
  return joined;
}

}  // namespace slammot::dds
