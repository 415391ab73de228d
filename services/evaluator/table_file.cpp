#include "services/evaluator/table_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/files/line_reader.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using files::LineReader;

Error fault_at(const std::filesystem::path& path, const LineReader& reader,
               const std::string& what) {
  return {path.string() + ":" + std::to_string(reader.line_number()) + ": " + what};
}

void split_at_commas(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
}

void split_at_blanks(std::string_view line, std::vector<std::string_view>& fields) {
  constexpr std::string_view kBlanks = " \t";
  fields.clear();
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
}

constexpr double kLargest = 9e9;  // Greatest number of seconds whose nanoseconds fit into 64 bits.

std::optional<Error> cut_fault(const std::filesystem::path& path, const LineReader& reader) {
  if (reader.is_cut()) return Error{path.string() + ": the file is cut off or damaged"};
  return std::nullopt;
}

}  // namespace

std::optional<Error> read_csv(const std::filesystem::path& path,
                              const std::vector<std::string_view>& columns, const TakeRow& take) {
  auto reader = LineReader::open(path);
  if (!reader) return reader.error();
  const auto header = reader->next();
  if (!header) return Error{path.string() + ": no header"};
  std::vector<std::string_view> fields;
  split_at_commas(*header, fields);
  std::vector<std::size_t> places;
  for (const std::string_view column : columns) {
    const auto place = std::find(fields.begin(), fields.end(), column);
    if (place == fields.end()) return fault_at(path, *reader, "no column " + std::string(column));
    places.push_back(static_cast<std::size_t>(place - fields.begin()));
  }
  const std::size_t width = fields.size();
  std::vector<std::string_view> chosen(places.size());
  while (const auto line = reader->next()) {
    if (line->empty()) continue;
    split_at_commas(*line, fields);
    if (fields.size() != width)
      return fault_at(
          path, *reader,
          std::to_string(fields.size()) + " fields where the header has " + std::to_string(width));
    std::transform(places.begin(), places.end(), chosen.begin(),
                   [&](std::size_t place) { return fields[place]; });
    if (const RowFault fault = take(chosen)) return fault_at(path, *reader, *fault);
  }
  return cut_fault(path, *reader);
}

std::vector<std::string> columns_with_prefix(const std::filesystem::path& path,
                                             std::string_view beginning) {
  auto reader = LineReader::open(path);
  const auto header = reader ? reader->next() : std::nullopt;
  std::vector<std::string_view> fields;
  if (header) split_at_commas(*header, fields);
  std::vector<std::string> names;
  for (const std::string_view field : fields) {
    if (field.starts_with(beginning)) names.emplace_back(field);
  }
  return names;
}

std::optional<Error> read_fields(const std::filesystem::path& path, std::size_t least_fields,
                                 const TakeRow& take) {
  auto reader = LineReader::open(path);
  if (!reader) return reader.error();
  std::vector<std::string_view> fields;
  while (const auto line = reader->next()) {
    if (line->empty() || line->front() == '#') continue;
    split_at_blanks(*line, fields);
    if (fields.empty()) continue;
    if (fields.size() < least_fields)
      return fault_at(path, *reader,
                      std::to_string(fields.size()) + " fields where " +
                          std::to_string(least_fields) + " are needed");
    if (const RowFault fault = take(fields)) return fault_at(path, *reader, *fault);
  }
  return cut_fault(path, *reader);
}

std::optional<std::vector<double>> numbers(std::span<const std::string_view> fields) {
  std::vector<double> values;
  values.reserve(fields.size());
  for (const std::string_view field : fields) {
    double value = 0.0;
    const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (fault != std::errc() || end != field.data() + field.size() ||
        !(std::abs(value) <= kLargest))
      return std::nullopt;
    values.push_back(value);
  }
  return values;
}

std::int64_t to_ns(double seconds) { return std::llround(seconds * 1e9); }

std::filesystem::path with_ending(const std::filesystem::path& prefix, std::string_view ending) {
  return prefix.string() + std::string(ending);
}

std::optional<std::filesystem::path> plain_or_gz(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return path;
  const std::filesystem::path zipped = path.string() + ".gz";
  if (std::filesystem::is_regular_file(zipped, ignored)) return zipped;
  return std::nullopt;
}

}  // namespace slammot::evaluator
