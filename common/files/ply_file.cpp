#include "common/files/ply_file.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

namespace slammot::files {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as it is in memory");

constexpr std::string_view kBeginning = "ply\nformat binary_little_endian 1.0\nelement vertex ";
constexpr std::string_view kVertex =
    "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\n";
constexpr std::string_view kFaces = "element face ";
constexpr std::string_view kFace = "property list uchar uint vertex_indices\n";
constexpr std::string_view kEndOfHeader = "end_header\n";
constexpr std::size_t kVertexBytes = 3 * sizeof(float) + 3;
constexpr std::size_t kQuadBytes = 1 + 4 * sizeof(std::uint32_t);

template <typename Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Reads text and values from the front; stays empty after the first fault.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  bool skip(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  /// A number and the end of its line.
  std::optional<std::size_t> count() {
    std::size_t number = 0;
    const auto [end, fault] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    if (fault != std::errc()) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return skip("\n") ? std::optional(number) : std::nullopt;
  }
  /// Precondition: size() is enough.
  template <typename Value>
  Value value() {
    Value value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  std::size_t size() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

}  // namespace

std::string to_ply(const PlyModel& model) {
  std::string bytes(kBeginning);
  bytes += std::to_string(model.vertices.size()) + "\n";
  bytes += kVertex;
  if (!model.quads.empty()) {
    bytes += kFaces;
    bytes += std::to_string(model.quads.size()) + "\n";
    bytes += kFace;
  }
  bytes += kEndOfHeader;
  bytes.reserve(bytes.size() + model.vertices.size() * kVertexBytes +
                model.quads.size() * kQuadBytes);
  for (const PlyVertex& vertex : model.vertices) {
    for (const float value : vertex.position_m) append(bytes, value);
    for (const std::uint8_t value : vertex.colour) append(bytes, value);
  }
  for (const auto& quad : model.quads) {
    append(bytes, std::uint8_t{4});
    for (const std::uint32_t index : quad) append(bytes, index);
  }
  return bytes;
}

Result<PlyModel> parse_ply(std::string_view bytes, const std::string& name) {
  const Error fault{name + ": not a model as slammot model writes it, or cut off"};
  Reader reader(bytes);
  if (!reader.skip(kBeginning)) return fault;
  const auto vertices = reader.count();
  if (!vertices || !reader.skip(kVertex)) return fault;
  std::optional<std::size_t> quads = 0;
  if (reader.skip(kFaces)) {
    quads = reader.count();
    if (!quads || !reader.skip(kFace)) return fault;
  }
  if (!reader.skip(kEndOfHeader)) return fault;
  if (*vertices > reader.size() / kVertexBytes || *quads > reader.size() / kQuadBytes ||
      reader.size() != *vertices * kVertexBytes + *quads * kQuadBytes)
    return fault;
  PlyModel model;
  model.vertices.resize(*vertices);
  for (PlyVertex& vertex : model.vertices) {
    vertex.position_m = reader.value<std::array<float, 3>>();
    vertex.colour = reader.value<Rgb>();
    for (const float value : vertex.position_m) {
      if (!std::isfinite(value)) return fault;
    }
  }
  model.quads.resize(*quads);
  for (auto& quad : model.quads) {
    if (reader.value<std::uint8_t>() != 4) return fault;
    quad = reader.value<std::array<std::uint32_t, 4>>();
    for (const std::uint32_t index : quad) {
      if (index >= *vertices) return fault;
    }
  }
  return model;
}

Result<PlyModel> read_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{path.string() + ": cannot be read (slammot model writes it)"};
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return parse_ply(bytes, path.string());
}

}  // namespace slammot::files
