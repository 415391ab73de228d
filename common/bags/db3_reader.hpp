#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "common/bags/message_source.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace slammot::bags {

/// Reads the SQLite file of a rosbag2, also one that is packed by zstd as a whole. Rows come in the
/// order in which they were written.
class Db3Reader : public MessageSource {
 public:
  explicit Db3Reader(const std::filesystem::path& path);

  std::optional<RawMessage> next() override;
  double fraction_read() const override;
  std::string damage() const override { return damage_; }

 private:
  struct CloseDatabase {
    void operator()(sqlite3* database) const;
  };
  struct EndStatement {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, EndStatement>;

  bool open(const std::filesystem::path& path);
  bool open_packed(const std::filesystem::path& path);
  bool has_tables();
  Statement prepare(const char* query);
  void read_channels();
  void note(const std::string& damage);
  void note_fault();

  std::vector<std::uint8_t> unpacked_;  ///< The whole file, where it is packed. Before the
                                        ///< database: it must outlive it.
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  Statement messages_;
  std::map<std::int64_t, Channel> channels_;
  std::int64_t rows_ = 0;
  std::int64_t last_row_ = 0;
  std::string damage_;
};

}  // namespace slammot::bags
