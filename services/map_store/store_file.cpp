#include <sys/stat.h>

#include "services/map_store/sqlite_statement.hpp"
#include "services/map_store/store.hpp"

namespace slammot::map_store {

std::optional<Store::Identity> Store::identity_of(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) return std::nullopt;
  return Identity{found.st_dev, found.st_ino};
}

Store::FileState Store::keep_file() {
  last_fault_.clear();
  const std::optional<Identity> now = identity_of(file_);
  if (now == identity_) return FileState::kThere;
  if (now) {
    last_fault_ = file_.string() + " was replaced by another file: restart to use that one";
    return FileState::kGone;
  }
  if (const auto fault = write_anew()) {
    last_fault_ = file_.string() + " was deleted: " + *fault;
    return FileState::kGone;
  }
  return FileState::kWrittenAnew;
}

/// The open connection still reads the deleted file.
std::optional<std::string> Store::write_anew() {
  std::error_code ignored_fault;
  for (const char* ending : {"-wal", "-shm"})  // of the deleted file: SQLite would apply them
    std::filesystem::remove(file_.string() + ending, ignored_fault);
  if (file_.has_parent_path())
    std::filesystem::create_directories(file_.parent_path(), ignored_fault);
  const std::string unfinished = file_.string() + ".unfinished";  // a full disk leaves a part of it
  std::filesystem::remove(unfinished, ignored_fault);
  try {
    Statement copy(database_.get(), "VACUUM INTO ?");
    copy << std::string_view(unfinished);
    copy.step();
  } catch (const SqliteError& error) {
    std::filesystem::remove(unfinished, ignored_fault);
    return error.what();
  }
  std::error_code fault;
  std::filesystem::rename(unfinished, file_, fault);
  if (fault) return fault.message();
  auto opened = open(file_, config_);
  if (auto* const why = std::get_if<std::string>(&opened)) return std::move(*why);
  *this = std::move(std::get<Store>(opened));
  return std::nullopt;
}

}  // namespace slammot::map_store
