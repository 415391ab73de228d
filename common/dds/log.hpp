#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::dds {

enum class LogLevel { kInfo, kWarning, kError };

using LogHandler = std::function<void(LogLevel, std::string_view line)>;

/// Sets the handler of the DDS library's messages: one line a call, from any thread; stderr by
/// default.
void set_log_handler(LogHandler handler);

/// Captures the DDS library's messages while it exists, instead of passing them to the handler:
/// they contain the reason of a failure of which the library returns only "Error". At most one
/// exists at a time; a second one waits.
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
