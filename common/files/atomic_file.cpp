#include "common/files/atomic_file.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include <unistd.h>

#include "common/files/text.hpp"

namespace slammot::files {
namespace {

Error last_fault(const std::filesystem::path& path) {
  return Error{"cannot write " + path.string() + ": " + std::strerror(errno)};
}

/// True when every byte has reached the file; errno says why not.
bool write_whole_file(const std::filesystem::path& path, std::string_view content) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return false;
  const bool is_written = std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
                          std::fflush(file) == 0;
  const int fault = errno;
  const bool is_closed = std::fclose(file) == 0;
  if (!is_written) errno = fault;
  return is_written && is_closed;
}

}  // namespace

std::optional<Error> write_file_atomically(const std::filesystem::path& path,
                                           std::string_view content) {
  const std::filesystem::path temporary = path.string() + ".tmp" + std::to_string(::getpid());
  if (write_whole_file(temporary, content) && std::rename(temporary.c_str(), path.c_str()) == 0)
    return std::nullopt;
  Error fault = last_fault(path);
  std::error_code is_gone;
  std::filesystem::remove(temporary, is_gone);
  return fault;
}

std::optional<Error> prepare_output_folder(const std::filesystem::path& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) return Error{"cannot make the folder " + folder.string() + ": " + fault.message()};
  const std::filesystem::path probe = folder / (".probe" + std::to_string(::getpid()));
  if (auto unwritable = write_file_atomically(probe, "probe"))
    return Error{"cannot write in " + folder.string() + ": " + std::strerror(errno)};
  std::filesystem::remove(probe, fault);
  return std::nullopt;
}

std::optional<Error> find_lack_of_space(const std::filesystem::path& folder, std::uint64_t needed) {
  constexpr double kMegabyte = 1e6;
  std::error_code fault;
  const std::filesystem::space_info space = std::filesystem::space(folder, fault);
  if (fault || space.available >= needed) return std::nullopt;
  return Error{text("%s: %.0f MB are free, about %.0f MB are needed", folder.c_str(),
                    static_cast<double>(space.available) / kMegabyte,
                    std::ceil(static_cast<double>(needed) / kMegabyte))};
}

}  // namespace slammot::files
