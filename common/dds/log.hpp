#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::dds {

enum class LogLevel { kInfo, kWarning, kError };

using LogHandler = std::function<void(LogLevel, std::string_view line)>;

/// Where the DDS library's own messages go from now on, one line a call, from any thread; stderr until this is called.
void set_log_handler(LogHandler handler);

/// While it lives, the DDS library's messages are kept here instead of going to the handler: they hold the reason of a
/// failure of which the library returns only "Error". At most one lives at a time; a second one waits.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  /// The errors so far, joined by "; ". Empty when there was none.
  std::string errors() const;
};

}  // namespace slammot::dds
