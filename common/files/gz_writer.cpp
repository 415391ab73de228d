#include "common/files/gz_writer.hpp"

#include <zlib.h>

namespace slammot::files {

void GzWriter::Close::operator()(gzFile_s* file) const { gzclose_w(file); }

GzWriter::GzWriter(const std::filesystem::path& path)
    : path_(path), file_(gzopen(path.c_str(), "wb1")) {
  has_failed_ = !file_;
}

void GzWriter::write(std::string_view text) {
  if (!file_ || text.empty()) return;
  has_failed_ =
      has_failed_ || gzwrite(file_.get(), text.data(), static_cast<unsigned>(text.size())) == 0;
}

std::optional<Error> GzWriter::close() {
  if (file_) has_failed_ = gzclose_w(file_.release()) != Z_OK || has_failed_;
  if (has_failed_) return Error{"cannot write all of " + path_.string()};
  return std::nullopt;
}

}  // namespace slammot::files
