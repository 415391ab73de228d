#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/result.hpp"

namespace slammot::evaluator {

/// What is wrong with a row, or nothing.
using RowFault = std::optional<std::string>;
using TakeRow = std::function<RowFault(std::span<const std::string_view> fields)>;

/// Hands over each row of a file with commas and a header: the named columns, in the order asked
/// for. Stops with "FILE:LINE: what" at the first row that is malformed, and where a column is
/// missing or the file is cut off.
std::optional<files::Error> read_csv(const std::filesystem::path& path,
                                     const std::vector<std::string_view>& columns,
                                     const TakeRow& take);

/// Names in the header of such a file that begin like this; none where it cannot be read.
std::vector<std::string> columns_beginning_with(const std::filesystem::path& path,
                                                std::string_view beginning);

/// As read_csv, for a file with blanks between its fields and no header: lines that begin with #
/// are left out, the others have at least so many fields.
std::optional<files::Error> read_fields(const std::filesystem::path& path, std::size_t least_fields,
                                        const TakeRow& take);

/// The numbers in the fields; nullopt where one is no finite number, or too large for a clock or a
/// map of the earth.
std::optional<std::vector<double>> numbers(std::span<const std::string_view> fields);

/// Seconds as nanoseconds.
std::int64_t to_ns(double seconds);

/// The file, or the same with ".gz" behind its name; nullopt where there is neither.
std::optional<std::filesystem::path> plain_or_gz(const std::filesystem::path& path);

}  // namespace slammot::evaluator
