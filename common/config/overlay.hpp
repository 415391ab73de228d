#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/fields.hpp"

namespace slammot::config {

/// Error of a configuration, with its location.
struct Fault {
  std::string file;
  int line = 0;    ///< From 1; 0 if the error is about the whole file.
  int column = 0;  ///< From 1.
  std::string message;

  /// "file:line:column: message", as compilers write it.
  std::string text() const;
};

/// Overlays what the text sets onto the bound stages; before it the profile that it names as its
/// `base`, if it does. Stages that are not bound are checked for syntax and names only. On a fault
/// (the first one) the stages may be partly overlaid and must not be used.
std::optional<Fault> overlay_text(std::string_view text, const std::string& file_name,
                                  std::span<const BoundStage> stages);

/// The same for a file. A file that cannot be read is a fault.
std::optional<Fault> overlay_file(const std::filesystem::path& file,
                                  std::span<const BoundStage> stages);

/// Overlays a text of a message other than Profile, such as a Scenario, onto its bound settings.
std::optional<Fault> overlay_message_text(std::string_view text, const std::string& file_name,
                                          const BoundStage& message);
std::optional<Fault> overlay_message_file(const std::filesystem::path& file,
                                          const BoundStage& message);

/// Differences between a field table and slammot.proto in names or types, one line each; empty if
/// they agree. Each list grows by a sample.
std::vector<std::string> differences_from_proto(const BoundStage& stage);

/// Names of the stages that slammot.proto knows.
std::vector<std::string> stages_in_proto();

}  // namespace slammot::config
