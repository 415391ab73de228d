#include "common/bags/db3_reader.hpp"

#include <algorithm>

#include <sqlite3.h>

#include "common/bags/byte_source.hpp"
#include "common/bags/unpack.hpp"

namespace slammot::bags {
namespace {

constexpr std::size_t kMostPackedFileBytes = std::size_t{1} << 30;

std::string text_in(sqlite3_stmt* row, int column) {
  const auto* const text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr
             ? std::string()
             : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

}  // namespace

void Db3Reader::CloseDatabase::operator()(sqlite3* database) const { sqlite3_close_v2(database); }
void Db3Reader::EndStatement::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Db3Reader::Db3Reader(const std::filesystem::path& path) {
  const bool is_packed = is_zstd(first_bytes(path, 4));
  if (is_packed ? !open_packed(path) : !open(path)) return;
  sqlite3* const database = database_.get();
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostUnpackedBytes));
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  if (!has_tables()) return;
  read_channels();
  if (const Statement last = prepare("SELECT max(rowid) FROM messages");
      last && sqlite3_step(last.get()) == SQLITE_ROW)
    last_row_ = sqlite3_column_int64(last.get(), 0);
  messages_ = prepare("SELECT topic_id, timestamp, data, rowid FROM messages ORDER BY rowid");
}

void Db3Reader::note(const std::string& damage) {
  if (damage_.empty()) damage_ = damage;
}

void Db3Reader::note_fault() {
  note("the database: " + std::string(sqlite3_errmsg(database_.get())));
}

bool Db3Reader::open(const std::filesystem::path& path) {
  sqlite3* database = nullptr;
  const int outcome = sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
  database_.reset(database);
  if (outcome != SQLITE_OK) note_fault();
  return outcome == SQLITE_OK;
}

bool Db3Reader::open_packed(const std::filesystem::path& path) {
  ByteSource file(path);
  file.read(kMostPackedFileBytes, unpacked_);
  if (unpacked_.size() == kMostPackedFileBytes)
    return note("the database is too large to be unpacked into memory: unpack it by zstd -d"),
           false;
  if (file.is_damaged())
    note("the packed file is cut off or damaged at byte " + std::to_string(unpacked_.size()) +
         " of what it unpacks to");
  sqlite3* database = nullptr;
  const int outcome = sqlite3_open_v2(":memory:", &database, SQLITE_OPEN_READWRITE, nullptr);
  database_.reset(database);
  if (outcome != SQLITE_OK) return note_fault(), false;
  const auto size = static_cast<sqlite3_int64>(unpacked_.size());
  if (sqlite3_deserialize(database, "main", unpacked_.data(), size, size,
                          SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    return note_fault(), false;
  return true;
}

/// True tables only: a view or a virtual table could be anything, without an end.
bool Db3Reader::has_tables() {
  const Statement tables = prepare(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages') "
      "AND sql NOT LIKE 'CREATE VIRTUAL%'");
  if (!tables || sqlite3_step(tables.get()) != SQLITE_ROW) return note_fault(), false;
  const bool has_both = sqlite3_column_int(tables.get(), 0) == 2;
  if (!has_both) note("the database has no tables of topics and messages");
  return has_both;
}

Db3Reader::Statement Db3Reader::prepare(const char* query) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), query, -1, &statement, nullptr) != SQLITE_OK)
    note_fault();
  return Statement(statement);
}

void Db3Reader::read_channels() {
  const Statement topics = prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!topics) return;
  int outcome = sqlite3_step(topics.get());
  for (; outcome == SQLITE_ROW && channels_.size() < kMaxChannels;
       outcome = sqlite3_step(topics.get())) {
    Channel channel;
    channel.topic = text_in(topics.get(), 1);
    channel.type = without_msg(text_in(topics.get(), 2));
    channel.serialization =
        text_in(topics.get(), 3) == "cdr" ? Serialization::kCdr : Serialization::kOther;
    channels_.emplace(sqlite3_column_int64(topics.get(), 0), std::move(channel));
  }
  if (outcome != SQLITE_DONE && outcome != SQLITE_ROW) note_fault();
}

std::optional<RawMessage> Db3Reader::next() {
  while (messages_) {
    const int outcome = sqlite3_step(messages_.get());
    if (outcome != SQLITE_ROW) {
      if (outcome != SQLITE_DONE) note_fault();
      messages_.reset();
      return std::nullopt;
    }
    rows_ = sqlite3_column_int64(messages_.get(), 3);
    const auto channel = channels_.find(sqlite3_column_int64(messages_.get(), 0));
    if (channel == channels_.end()) continue;
    const auto* const data =
        static_cast<const std::uint8_t*>(sqlite3_column_blob(messages_.get(), 2));
    Bytes bytes(data, data == nullptr
                          ? 0
                          : static_cast<std::size_t>(sqlite3_column_bytes(messages_.get(), 2)));
    return RawMessage{&channel->second, sqlite3_column_int64(messages_.get(), 1), bytes};
  }
  return std::nullopt;
}

double Db3Reader::fraction_read() const {
  if (!messages_ || last_row_ <= 0) return 1.0;
  return std::clamp(static_cast<double>(rows_) / static_cast<double>(last_row_), 0.0, 1.0);
}

}  // namespace slammot::bags
