#include "common/files/leg_tracker_log.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/decimal.hpp"

namespace slammot::files {
namespace {

std::filesystem::path plain_or_gz(std::filesystem::path path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return path;
  return path += ".gz";
}

/// Words of the line; the last one contains the rest.
std::vector<std::string_view> words_of(std::string_view line, std::size_t most) {
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(" \t");
       begin != std::string_view::npos && words.size() < most;) {
    const bool is_last = words.size() + 1 == most;
    const std::size_t end =
        is_last ? line.size() : std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(" \t", end);
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  return fault == std::errc() && end == word.data() + word.size() ? std::optional(value)
                                                                  : std::nullopt;
}

std::string stamps(double stamp_s) {
  const std::string stamp = fixed_text(stamp_s, 6);
  return ' ' + stamp + " recorded " + stamp;
}

}  // namespace

Result<std::unique_ptr<LineSource>> LegTrackerLog::open(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  auto scans = LineReader::open(is_folder ? plain_or_gz(path / "scan.txt") : path);
  if (!scans) return scans.error();
  const std::filesystem::path odometry_path = plain_or_gz(path / "odom.txt");
  std::optional<LineReader> odometry;
  if (is_folder && std::filesystem::exists(odometry_path, ignored)) {
    auto opened = LineReader::open(odometry_path);
    if (!opened) return opened.error();
    odometry = std::move(*opened);
  }
  return std::unique_ptr<LineSource>(new LegTrackerLog(std::move(*scans), std::move(odometry)));
}

bool LegTrackerLog::is_scan_file(const std::filesystem::path& path) {
  constexpr std::size_t kNumbersBeforeRanges = 5;
  auto lines = LineReader::open(path);
  if (!lines) return false;
  while (const auto line = lines->next()) {
    if (line->empty() || line->front() == '#') continue;
    const auto words = words_of(*line, kMaxBeams + kNumbersBeforeRanges + 1);
    if (words.size() <= kNumbersBeforeRanges) return false;
    const bool begins_with_numbers =
        std::all_of(words.begin(), words.begin() + kNumbersBeforeRanges,
                    [](std::string_view word) { return number(word).has_value(); });
    return begins_with_numbers &&
           number(words[4]) == static_cast<double>(words.size() - kNumbersBeforeRanges);
  }
  return false;
}

std::optional<LegTrackerLog::Line> LegTrackerLog::next_scan() {
  while (const auto line = scans_.next()) {
    const auto words = words_of(*line, 6);
    if (words.empty() || words[0].starts_with('#')) continue;
    if (words.size() < 6) return Line{0.0, "ROBOTLASER1 malformed"};  // counted as malformed
    const auto bag_s = number(words[0]), step_rad = number(words[3]), beams = number(words[4]);
    if (!bag_s || !step_rad || !beams) return Line{0.0, "ROBOTLASER1 malformed"};
    std::string text = "ROBOTLASER1 0 " + std::string(words[2]) + ' ' +
                       fixed_text(*step_rad * (*beams - 1.0), 8) + ' ' + std::string(words[3]) +
                       " 0 0.01 0 ";
    text += std::string(words[4]) + ' ' + std::string(words[5]) + " 0 0 0 0 0 0 0 0 0 0 0 0" +
            stamps(*bag_s);
    return Line{*bag_s, std::move(text)};
  }
  return std::nullopt;
}

std::optional<LegTrackerLog::Line> LegTrackerLog::next_odometry() {
  if (!odometry_) return std::nullopt;
  while (const auto line = odometry_->next()) {
    const auto words = words_of(*line, 6);
    if (words.empty() || words[0].starts_with('#')) continue;
    const auto stamp_s = number(words[0]);
    if (words.size() < 6 || !stamp_s) return Line{0.0, "ODOM malformed"};
    std::string text = "ODOM";
    for (std::size_t i = 1; i < words.size(); ++i) text += ' ' + std::string(words[i]);
    return Line{*stamp_s, text + " 0" + stamps(*stamp_s)};
  }
  return std::nullopt;
}

std::optional<std::string_view> LegTrackerLog::next() {
  if (!scan_) scan_ = next_scan();
  if (!odom_) odom_ = next_odometry();
  if (!scan_ && !odom_) return std::nullopt;
  const bool odometry_is_first = odom_ && (!scan_ || odom_->stamp_s <= scan_->stamp_s);
  line_ = std::exchange(odometry_is_first ? odom_ : scan_, std::nullopt)->text;
  return line_;
}

}  // namespace slammot::files
