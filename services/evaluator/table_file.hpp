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

/// Fault of a row; empty if there is none.
using RowFault = std::optional<std::string>;
using TakeRow = std::function<RowFault(std::span<const std::string_view> fields)>;

/// Passes each row of a comma-separated file with a header to `take`: the named columns in the
/// given order. Stops with "FILE:LINE: what" at the first malformed row, a missing column or a
/// truncated file.
std::optional<files::Error> read_csv(const std::filesystem::path& path,
                                     const std::vector<std::string_view>& columns,
                                     const TakeRow& take);

/// Columns whose names begin with the prefix; empty if the file cannot be read.
std::vector<std::string> columns_with_prefix(const std::filesystem::path& path,
                                             std::string_view beginning);

/// Like read_csv(), for files with fields separated by blanks and without a header. Skips lines
/// that begin with #; the others have at least `least_fields` fields.
std::optional<files::Error> read_fields(const std::filesystem::path& path, std::size_t least_fields,
                                        const TakeRow& take);

/// The numbers in the fields; nullopt if one is not finite, or too large for a stamp or a
/// coordinate.
std::optional<std::vector<double>> numbers(std::span<const std::string_view> fields);

/// Converts seconds to nanoseconds.
std::int64_t to_ns(double seconds);

/// PREFIX with an ending such as ".walls.csv".
std::filesystem::path with_ending(const std::filesystem::path& prefix, std::string_view ending);

/// The file or, if it does not exist, the file with ".gz" appended; nullopt if neither exists.
std::optional<std::filesystem::path> plain_or_gz(const std::filesystem::path& path);

}  // namespace slammot::evaluator
