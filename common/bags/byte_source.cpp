#include "common/bags/byte_source.hpp"

#include <algorithm>

#include <zstd.h>

namespace slammot::bags {
namespace {

constexpr std::size_t kStepBytes = std::size_t{1} << 20;

}  // namespace

void ByteSource::Free::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

ByteSource::ByteSource(const std::filesystem::path& path) : file_(path, std::ios::binary) {
  if (!file_) return;
  std::error_code fault;
  const std::uintmax_t size = std::filesystem::file_size(path, fault);
  file_bytes_ = fault ? 0 : size;
  if (is_zstd(first_bytes(path, 4))) unpacks_.reset(ZSTD_createDCtx());
}

ByteSource::~ByteSource() = default;
ByteSource::ByteSource(ByteSource&&) noexcept = default;

std::size_t ByteSource::read_some(std::uint8_t* into, std::size_t count) {
  file_.read(reinterpret_cast<char*>(into), static_cast<std::streamsize>(count));
  const auto read = static_cast<std::size_t>(std::max<std::streamsize>(0, file_.gcount()));
  file_bytes_read_ += read;
  return read;
}

std::size_t ByteSource::unpack_some(std::uint8_t* into, std::size_t count) {
  ZSTD_outBuffer out{into, count, 0};
  while (out.pos == 0 && !is_damaged_) {
    if (packed_at_ == packed_.size()) {
      packed_.resize(kStepBytes / 8);
      packed_.resize(read_some(packed_.data(), packed_.size()));
      packed_at_ = 0;
      if (packed_.empty()) {
        is_damaged_ = frame_is_open_;
        return 0;
      }
    }
    ZSTD_inBuffer in{packed_.data(), packed_.size(), packed_at_};
    const std::size_t outcome = ZSTD_decompressStream(unpacks_.get(), &out, &in);
    packed_at_ = in.pos;
    is_damaged_ = ZSTD_isError(outcome) != 0;
    frame_is_open_ = outcome != 0;
  }
  return out.pos;
}

void ByteSource::read(std::uint64_t count, std::vector<std::uint8_t>& into) {
  into.clear();
  while (into.size() < count) {
    const std::size_t had = into.size();
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(count - had, kStepBytes));
    into.resize(had + step);
    const std::size_t got =
        unpacks_ ? unpack_some(into.data() + had, step) : read_some(into.data() + had, step);
    into.resize(had + got);
    position_ += got;
    if (got == 0) return;
  }
}

bool ByteSource::skip(std::uint64_t count) {
  if (!unpacks_ && file_bytes_ >= file_bytes_read_) {
    const std::uint64_t there = std::min(count, file_bytes_ - file_bytes_read_);
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(there), std::ios::cur);
    file_bytes_read_ += there;
    position_ += there;
    return there == count;
  }
  std::vector<std::uint8_t> skipped;
  while (count > 0) {
    read(std::min<std::uint64_t>(count, kStepBytes), skipped);
    if (skipped.empty()) return false;
    count -= skipped.size();
  }
  return true;
}

double ByteSource::fraction_read() const {
  return file_bytes_ == 0 ? 1.0
                          : std::min(1.0, static_cast<double>(file_bytes_read_) /
                                              static_cast<double>(file_bytes_));
}

std::string first_bytes(const std::filesystem::path& path, std::size_t count) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(count, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
}

bool is_zstd(std::string_view first_bytes) { return first_bytes.starts_with("\x28\xB5\x2F\xFD"); }

}  // namespace slammot::bags
