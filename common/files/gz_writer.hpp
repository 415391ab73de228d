#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "common/files/result.hpp"

struct gzFile_s;

namespace slammot::files {

/// Writes text into a .gz file, fast rather than small. The same text gives the same bytes.
class GzWriter {
 public:
  explicit GzWriter(const std::filesystem::path& path);

  void write(std::string_view text);

  /// Ends the file; why it is not complete, if it is not.
  std::optional<Error> close();

 private:
  struct Close {
    void operator()(gzFile_s* file) const;
  };
  std::filesystem::path path_;
  std::unique_ptr<gzFile_s, Close> file_;  ///< Null where it could not be opened, and once closed.
  bool has_failed_ = false;
};

}  // namespace slammot::files
