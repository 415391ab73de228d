#include "common/app/state_file.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <utility>

#include <zlib.h>

#include "common/app/give_way.hpp"
#include "common/app/log.hpp"

namespace slammot::app {
namespace {

constexpr std::array<char, 8> kMagic = {'s', 'l', 'a', 'm', 'm', 'o', 't', '1'};

/// Header of the file, which is written and read on the same machine by the same build.
struct Header {
  std::array<char, 8> magic = kMagic;
  std::int64_t stamp_ns = 0;
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;
};

std::uint64_t checksum_of(const std::vector<std::byte>& bytes) {
  return ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

/// None if the file is damaged.
std::optional<SavedState> read_state(std::istream& file, const std::filesystem::path& path) {
  Header header;
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != kMagic)
    return std::nullopt;
  std::error_code unreadable;
  if (std::filesystem::file_size(path, unreadable) != sizeof header + header.size)
    return std::nullopt;
  SavedState state{header.stamp_ns, std::vector<std::byte>(header.size)};
  if (!file.read(reinterpret_cast<char*>(state.bytes.data()),
                 static_cast<std::streamsize>(header.size)))
    return std::nullopt;
  if (checksum_of(state.bytes) != header.checksum) return std::nullopt;
  return state;
}

}  // namespace

StateFile::StateFile(std::filesystem::path path)
    : path_(std::move(path)), thread_([this] { write_states(); }) {}

/// Writes the last state in this thread: nobody has to give way any more, and a standby waits.
StateFile::~StateFile() {
  std::optional<NextState> last;
  {
    const std::scoped_lock lock(mutex_);
    is_closing_ = true;
    last = std::exchange(next_, std::nullopt);
  }
  changed_.notify_all();
  thread_.join();
  if (last) write({last->stamp_ns, last->make_bytes()});
}

std::optional<SavedState> StateFile::read() const {
  std::ifstream file(path_, std::ios::binary);
  if (!file) return std::nullopt;
  auto state = read_state(file, path_);
  if (!state) log_warn("{} is damaged or of another version: it is not used", path_.string());
  return state;
}

bool StateFile::is_busy() const {
  const std::scoped_lock lock(mutex_);
  return next_.has_value() || is_writing_;
}

void StateFile::save(std::int64_t stamp_ns, MakeBytes make_bytes) {
  {
    const std::scoped_lock lock(mutex_);
    next_ = {stamp_ns, std::move(make_bytes)};
  }
  changed_.notify_all();
}

void StateFile::save(SavedState state) {
  save(state.stamp_ns, [bytes = std::move(state.bytes)]() mutable { return std::move(bytes); });
}

std::string StateFile::fault() const {
  const std::scoped_lock lock(mutex_);
  return fault_;
}

void StateFile::write_states() {
  give_way();
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return next_ || is_closing_; });
    if (!next_) return;
    NextState next = *std::exchange(next_, std::nullopt);
    is_writing_ = true;
    lock.unlock();
    std::string fault = write({next.stamp_ns, next.make_bytes()});
    next = {};
    lock.lock();
    is_writing_ = false;
    fault_ = std::move(fault);
  }
}

std::string StateFile::write(const SavedState& state) const {
  std::error_code fault;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), fault);
  const std::filesystem::path unfinished = path_.string() + ".unfinished";
  const Header header{kMagic, state.stamp_ns, state.bytes.size(), checksum_of(state.bytes)};
  std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  file.write(reinterpret_cast<const char*>(state.bytes.data()),
             static_cast<std::streamsize>(state.bytes.size()));
  file.close();
  if (!file) {
    const std::string reason = std::strerror(errno);
    std::filesystem::remove(unfinished, fault);  // a full disk needs the room
    return "cannot write " + unfinished.string() + ": " + reason;
  }
  std::filesystem::rename(unfinished, path_, fault);
  return fault ? "cannot write " + path_.string() + ": " + fault.message() : std::string();
}

}  // namespace slammot::app
