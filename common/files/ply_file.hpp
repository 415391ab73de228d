#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/png_image.hpp"
#include "common/files/result.hpp"

namespace slammot::files {

struct PlyVertex {
  std::array<float, 3> position_m = {};
  Rgb colour = {};
};

/// Points, and faces of four corners over them.
struct PlyModel {
  std::vector<PlyVertex> vertices;
  std::vector<std::array<std::uint32_t, 4>> quads;  ///< Indices of vertices.
};

/// PLY 1.0, binary little endian: vertices x, y, z (float), red, green, blue (uchar); faces, if
/// there are any, as lists of four (uchar, uint). Turk 1994.
std::string to_ply(const PlyModel& model);

/// What to_ply() writes; fails with one line for anything else.
Result<PlyModel> parse_ply(std::string_view bytes, const std::string& name);
Result<PlyModel> read_ply(const std::filesystem::path& path);

}  // namespace slammot::files
