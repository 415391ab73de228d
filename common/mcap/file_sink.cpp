#include "common/mcap/file_sink.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace slammot::mcap {

FileSink::FileSink(const std::filesystem::path& path) : path_(path) {
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file_ < 0) fail(errno);
}

FileSink::~FileSink() {
  if (file_ >= 0) ::close(file_);
}

bool FileSink::fail(int error) {
  fault_ = path_.string() + ": " + std::strerror(error);
  return false;
}

bool FileSink::write(bags::Bytes bytes) {
  if (!fault_.empty()) return false;
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    position_ += static_cast<std::uint64_t>(written);
  }
  return true;
}

bool FileSink::cut_to(std::uint64_t position) {
  if (file_ < 0) return false;
  fault_.clear();
  const auto offset = static_cast<off_t>(position);
  if (::ftruncate(file_, offset) != 0 || ::lseek(file_, offset, SEEK_SET) != offset)
    return fail(errno);
  position_ = position;
  return true;
}

bool FileSink::close() {
  if (file_ < 0) return fault_.empty();
  const bool is_on_disk = ::fsync(file_) == 0 || errno == EINVAL;  // EINVAL: a pipe or the like
  if (!is_on_disk && fault_.empty()) fail(errno);
  if (::close(std::exchange(file_, -1)) != 0 && fault_.empty()) fail(errno);
  return fault_.empty();
}

}  // namespace slammot::mcap
