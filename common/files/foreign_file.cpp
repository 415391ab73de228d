#include "common/files/foreign_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <zlib.h>

namespace slammot::files {
namespace {

constexpr std::size_t kJudgedBytes = std::size_t{1} << 16;

struct ForeignKind {
  std::string_view magic;
  std::string_view meaning;
};

using std::string_view_literals::operator""sv;
constexpr std::array kForeignKinds = {
    ForeignKind{"\x1f\x8b"sv, "it is compressed by gzip twice: unpack it once (gunzip)"},
    ForeignKind{"BZh"sv, "it is compressed by bzip2: unpack it first (bunzip2)"},
    ForeignKind{"\xfd"
                "7zXZ\0"sv,
                "it is compressed by xz: unpack it first (unxz)"},
    ForeignKind{"\x04\x22\x4d\x18"sv, "it is compressed by lz4: unpack it first (unlz4)"},
    ForeignKind{"7z\xbc\xaf\x27\x1c"sv, "it is a 7z archive: unpack it first"},
    ForeignKind{"PK\x03\x04"sv, "it is a zip archive: unpack it first (unzip)"},
    ForeignKind{"%PDF"sv, "it is a PDF document"},
    ForeignKind{"\xff\xfe"sv, "its text is UTF-16: convert it first (iconv -f UTF-16 -t UTF-8)"},
    ForeignKind{"\xfe\xff"sv, "its text is UTF-16: convert it first (iconv -f UTF-16 -t UTF-8)"},
    ForeignKind{"version https://git-lfs"sv,
                "it is a Git LFS pointer, not the file itself: git lfs pull"},
    ForeignKind{"rosbag2_bagfile_information:"sv,
                "it is the metadata of a rosbag2 folder: name the folder"},
};

bool begins_as_html(std::string_view text) {
  constexpr std::size_t kLongestTag = 16;
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  std::string begin(text.substr(0, kLongestTag));
  std::ranges::transform(begin, begin.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return begin.starts_with("<!doctype html") || begin.starts_with("<html");
}

/// A tar archive has its magic bytes behind the name and the owner of its first file.
bool is_tar(std::string_view bytes) {
  constexpr std::size_t kMagicAt = 257;
  return bytes.size() > kMagicAt && bytes.substr(kMagicAt).starts_with("ustar");
}

bool is_of_text(char c) {
  constexpr unsigned char kFirstPrintable = 0x20;
  return static_cast<unsigned char>(c) >= kFirstPrintable || c == '\t' || c == '\r';
}

/// CR ends every line, as on an old Macintosh.
bool has_lines_of_cr_only(std::string_view text) {
  const std::size_t first = text.find('\r');
  return first != std::string_view::npos && first + 1 < text.size() &&
         std::ranges::all_of(text, is_of_text);  // so there is no '\n' either
}

struct CloseGz {
  void operator()(gzFile_s* file) const { gzclose_r(file); }
};

struct Beginning {
  std::string bytes;  ///< Of the content, if it is compressed by gzip.
  bool is_packed = false;
};

/// Empty for a file that cannot be read.
Beginning beginning_of(const std::filesystem::path& path) {
  const std::unique_ptr<gzFile_s, CloseGz> file(gzopen(path.c_str(), "rb"));
  if (!file) return {};
  std::string bytes(kJudgedBytes, '\0');
  const int count = gzread(file.get(), bytes.data(), static_cast<unsigned>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max(count, 0)));
  return {std::move(bytes), gzdirect(file.get()) == 0};
}

bool is_named_as_log(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 8> kEndings = {".log", ".log.gz", ".clf", ".clf.gz",
                                                        ".bag", ".mcap",   ".db3", ".txt.gz"};
  const std::string name = path.filename().string();
  return std::ranges::any_of(kEndings, [&](auto ending) { return name.ends_with(ending); });
}

std::vector<std::string> names_of_logs_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code fault;
  for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end;
       entry.increment(fault)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && is_named_as_log(entry->path()))
      names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

Error no_drive_in(const std::filesystem::path& folder) {
  constexpr std::size_t kMostNamed = 3;
  const std::vector<std::string> names = names_of_logs_in(folder);
  std::string message = folder.string() +
                        ": a folder without a drive: neither files of a ROS bag (.mcap, .db3, "
                        ".bag) nor leg_tracker's scan.txt";
  if (names.empty()) return Error{std::move(message)};
  message += names.size() == 1
                 ? "; it holds a file that may be a log ("
                 : "; it holds " + std::to_string(names.size()) + " files that may be logs (";
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamed); ++i)
    message += (i > 0 ? ", " : "") + names[i];
  message += names.size() > kMostNamed ? ", ...): name one" : "): name one";
  return Error{std::move(message)};
}

bool has_leg_tracker_scans(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::exists(folder / "scan.txt", ignored) ||
         std::filesystem::exists(folder / "scan.txt.gz", ignored);
}

}  // namespace

std::optional<std::string_view> foreign_content(std::string_view first_bytes) {
  for (const ForeignKind& kind : kForeignKinds) {
    if (first_bytes.starts_with(kind.magic)) return kind.meaning;
  }
  if (is_tar(first_bytes)) return "it is a tar archive: unpack it first (tar -xf)";
  if (begins_as_html(first_bytes))
    return "it is a web page (HTML): the download gave a page in place of the log";
  if (has_lines_of_cr_only(first_bytes))
    return "its lines end with CR alone: convert them first (tr '\\r' '\\n')";
  return std::nullopt;
}

std::optional<Error> find_foreign(const std::filesystem::path& path) {
  constexpr const char* kWhyAFile = ": a log is read several times and must be a file";
  std::error_code fault;
  const std::filesystem::file_status status = std::filesystem::status(path, fault);
  if (path == "-" && !std::filesystem::exists(status))
    return Error{std::string("standard input cannot be a log") + kWhyAFile};
  if (std::filesystem::is_fifo(status) || std::filesystem::is_socket(status) ||
      std::filesystem::is_character_file(status))
    return Error{path.string() + ": not a regular file" + kWhyAFile};
  if (std::filesystem::is_directory(status))
    return has_leg_tracker_scans(path) ? std::nullopt : std::optional(no_drive_in(path));
  if (!std::filesystem::is_regular_file(status)) return std::nullopt;
  const auto [bytes, is_packed] = beginning_of(path);
  const auto content = foreign_content(bytes);
  if (content) return Error{path.string() + ": " + std::string(*content)};
  const bool is_bag = bytes.starts_with("#ROSBAG") || bytes.starts_with("\x89MCAP0") ||
                      bytes.starts_with("SQLite format 3");
  if (is_bag && is_packed)
    return Error{path.string() + ": it is a bag compressed by gzip: unpack it first (gunzip)"};
  return std::nullopt;
}

}  // namespace slammot::files
