#include "common/files/log_formats.hpp"

#include <utility>

#include "common/bags/bag.hpp"
#include "common/files/bag_log.hpp"
#include "common/files/foreign_file.hpp"
#include "common/files/leg_tracker_log.hpp"
#include "common/files/line_reader.hpp"

namespace slammot::files {
namespace {

Result<std::unique_ptr<RecordSource>> records_of(Result<std::unique_ptr<LineSource>> lines) {
  if (!lines) return lines.error();
  return std::unique_ptr<RecordSource>(std::make_unique<CarmenLines>(std::move(*lines)));
}

Result<std::unique_ptr<LineSource>> open_text(const std::filesystem::path& path) {
  if (LegTrackerLog::is_scan_file(path)) return LegTrackerLog::open(path);
  auto lines = LineReader::open(path);
  if (!lines) return lines.error();
  return std::unique_ptr<LineSource>(std::make_unique<LineReader>(std::move(*lines)));
}

}  // namespace

Result<std::unique_ptr<RecordSource>> open_records(const std::filesystem::path& path,
                                                   const RecordOptions& options) {
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  if (is_folder && bags::is_bag(path)) return BagLog::open(path, options);
  if (auto fault = find_foreign(path)) return *fault;
  if (bags::is_bag(path)) return BagLog::open(path, options);
  if (is_folder) return records_of(LegTrackerLog::open(path));
  return records_of(open_text(path));
}

}  // namespace slammot::files
