#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <zlib.h>

namespace slammot::testing {

inline void write_file(const std::filesystem::path& path, std::string_view content) {
  std::ofstream(path, std::ios::binary) << content;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_gz(const std::filesystem::path& path, std::string_view content) {
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
}

struct FlaserLine {
  std::string ranges = "4 1.0 2.0 3.0 4.0";
  std::string pose = "0 0 0";
  std::string ipc = "1.5";
  std::string logger = "1.5";

  std::string text() const {
    return "FLASER " + ranges + " " + pose + " " + pose + " " + ipc + " host " + logger + "\n";
  }
};

/// A drive along x at 1 m/s with a scan every tenth of a second; poses as the wheels say.
inline std::string straight_drive(int scans) {
  std::string log;
  for (int i = 0; i < scans; ++i) {
    const std::string s = std::to_string(i / 10) + "." + std::to_string(i % 10);
    log += FlaserLine{.pose = s + " 0 0", .ipc = "100" + s, .logger = s}.text();
  }
  return log;
}

}  // namespace slammot::testing
