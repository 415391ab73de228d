#include "services/gateway/page_files.hpp"

#include <fstream>
#include <iterator>

#include "services/gateway/embedded_page.hpp"

namespace slammot::gateway {
namespace {

std::string type_of(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".svg") return "image/svg+xml";
  return "application/octet-stream";
}

PageFile page_file(const std::filesystem::path& name, std::string body) {
  PageFile file{(std::filesystem::path("/") / name).string(), {type_of(name), std::move(body)}};
  file.content.is_public = true;
  return file;
}

}  // namespace

std::vector<PageFile> built_in_page() {
  std::vector<PageFile> page;
  for (const files::EmbeddedFile& file : embedded_page())
    page.push_back(page_file(file.name, std::string(file.bytes)));
  return page;
}

std::vector<PageFile> page_in(const std::filesystem::path& folder) {
  std::vector<PageFile> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    files.push_back(
        page_file(entry.path().filename(), std::string(std::istreambuf_iterator<char>(file), {})));
  }
  return files;
}

}  // namespace slammot::gateway
