#include "common/app/state_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace slammot::app {
namespace {

std::string owner_of(const std::filesystem::path& path) {
  std::string number;
  std::ifstream(path) >> number;
  return number.empty() ? "another process" : "process " + number;
}

}  // namespace

void StateLock::release() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

/// A line of /proc/locks: "1: FLOCK  ADVISORY  WRITE 1903 00:2e:1234 0 EOF", with the process and
/// the inode.
std::optional<pid_t> StateLock::holder() const {
  struct stat own {};
  if (::stat(path_.c_str(), &own) != 0) return std::nullopt;
  const std::string inode = std::to_string(own.st_ino);
  std::ifstream locks("/proc/locks");
  std::string number, kind, mode, access, file;
  pid_t process = 0;
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    if (words >> number >> kind >> mode >> access >> process >> file && kind == "FLOCK" &&
        file.substr(file.rfind(':') + 1) == inode && process > 0)
      return process;
  }
  return std::nullopt;
}

StateLock::Outcome StateLock::try_lock() {
  reason_.clear();
  std::error_code ignored;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), ignored);
  if (file_ < 0) file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) {
    reason_ = "cannot lock " + path_.string() + ": " + std::strerror(errno);
    return Outcome::kCannot;
  }
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) {
    write_process_number();
    return Outcome::kLocked;
  }
  const bool is_in_use = errno == EWOULDBLOCK;
  reason_ = is_in_use ? path_.string() + " is in use by " + owner_of(path_)
                      : "cannot lock " + path_.string() + ": " + std::strerror(errno);
  return is_in_use ? Outcome::kInUse : Outcome::kCannot;
}

/// For the message of others; a full disk does not matter.
void StateLock::write_process_number() const {
  const std::string number = std::to_string(::getpid()) + "\n";
  if (::ftruncate(file_, 0) == 0) [[maybe_unused]]
    const ssize_t written = ::pwrite(file_, number.data(), number.size(), 0);
}

}  // namespace slammot::app
