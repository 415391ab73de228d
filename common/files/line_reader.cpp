#include "common/files/line_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <zlib.h>

namespace slammot::files {
namespace {

constexpr std::size_t kChunkBytes = 1 << 18;

std::string_view without_carriage_return(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

void LineReader::Close::operator()(gzFile_s* file) const { gzclose_r(file); }

LineReader::LineReader(std::unique_ptr<gzFile_s, Close> file, std::uintmax_t file_bytes)
    : file_(std::move(file)), file_bytes_(file_bytes) {
  unpack_ahead(std::vector<char>(kChunkBytes));
  chunk_.text.resize(kChunkBytes);
}

Result<LineReader> LineReader::open(const std::filesystem::path& path) {
  std::error_code fault;
  const std::filesystem::file_status status = std::filesystem::status(path, fault);
  if (status.type() == std::filesystem::file_type::not_found)
    return Error{path.string() + ": no such file"};
  if (fault) return Error{path.string() + ": " + fault.message()};
  if (status.type() != std::filesystem::file_type::regular)
    return Error{path.string() + ": not a regular file"};
  const std::uintmax_t file_bytes = std::filesystem::file_size(path, fault);
  if (fault) return Error{path.string() + ": " + fault.message()};
  if (file_bytes == 0) return Error{path.string() + ": the file is empty"};
  std::unique_ptr<gzFile_s, Close> file(gzopen(path.c_str(), "rb"));
  if (!file) return Error{path.string() + ": " + std::strerror(errno)};
  gzbuffer(file.get(), kChunkBytes);
  return LineReader(std::move(file), file_bytes);
}

std::optional<std::string_view> LineReader::next() {
  partial_.clear();
  while (begin_ < end_ || fill()) {
    const char* const start = chunk_.text.data() + begin_;
    const auto* const line_end = static_cast<const char*>(std::memchr(start, '\n', end_ - begin_));
    const std::string_view piece(
        start, line_end ? static_cast<std::size_t>(line_end - start) : end_ - begin_);
    begin_ += piece.size() + (line_end ? 1 : 0);
    if (!line_end) {
      keep(piece);
    } else if (auto line = finish_line(piece)) {
      return line;
    }
  }
  if (partial_.empty()) return std::nullopt;
  last_line_is_unfinished_ = true;
  ++line_number_;
  return without_carriage_return(partial_);
}

LineReader::Unpacked LineReader::unpack(gzFile_s* file, std::vector<char> into) {
  Unpacked unpacked;
  const int bytes = gzread(file, into.data(), static_cast<unsigned>(into.size()));
  int fault = Z_OK;
  gzerror(file, &fault);
  // Z_BUF_ERROR: the compressed stream ends too early; Z_DATA_ERROR: it is damaged. zlib returns
  // the data before that.
  unpacked.is_cut = bytes < 0 || fault != Z_OK;
  unpacked.bytes = static_cast<std::size_t>(std::max(bytes, 0));
  unpacked.bytes_read = static_cast<std::uintmax_t>(std::max<z_off_t>(gzoffset(file), 0));
  unpacked.text = std::move(into);
  return unpacked;
}

void LineReader::unpack_ahead(std::vector<char> into) {
  next_chunk_ =
      std::async(std::launch::async, [file = file_.get(), into = std::move(into)]() mutable {
        return unpack(file, std::move(into));
      });
}

bool LineReader::fill() {
  begin_ = end_ = 0;
  if (!next_chunk_.valid()) return false;
  std::vector<char> recycled = std::move(chunk_.text);
  chunk_ = next_chunk_.get();
  is_cut_ = is_cut_ || chunk_.is_cut;
  end_ = chunk_.bytes;
  if (end_ > 0 && !is_cut_) unpack_ahead(std::move(recycled));
  return end_ > 0;
}

void LineReader::keep(std::string_view piece) {
  if (!skips_line_ && partial_.size() + piece.size() <= kMaxLineBytes) {
    partial_.append(piece);
  } else {
    skips_line_ = true;
    partial_.clear();
  }
}

std::optional<std::string_view> LineReader::finish_line(std::string_view piece) {
  ++line_number_;
  if (skips_line_ || partial_.size() + piece.size() > kMaxLineBytes) {
    skips_line_ = false;
    partial_.clear();
    ++overlong_lines_;
    return std::nullopt;
  }
  if (partial_.empty()) return without_carriage_return(piece);
  partial_.append(piece);
  return without_carriage_return(partial_);
}

double LineReader::fraction_read() const {
  return std::min(1.0, static_cast<double>(chunk_.bytes_read) / static_cast<double>(file_bytes_));
}

}  // namespace slammot::files
