#include "common/bags/ros_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace slammot::bags {
namespace {

constexpr std::size_t kMostBeams = std::size_t{1} << 20;  // far more than any planar scanner has
constexpr std::size_t kMostTransforms = 65'536;

/// Takes a message's fields: ROS 1 packs them without gaps, CDR aligns each to its size (OMG
/// DDSI-RTPS 2.5, section 10; XTypes 1.3, 7.4.1: at most to 4 in its second version).
class Fields {
 public:
  explicit Fields(const RawMessage& message) : reader_(message.bytes) {
    if (message.channel->serialization == Serialization::kRos1) return;
    if (message.channel->serialization == Serialization::kCdr) read_encapsulation();
    else reader_.fail();
  }

  template <typename Number>
  Number number() {
    align(sizeof(Number));
    return reader_.number<Number>();
  }

  /// CDR counts the 0 at the end of a string.
  std::string text() {
    std::string_view text = text_of(reader_.take(number<std::uint32_t>()));
    if (is_cdr() && !text.empty() && text.back() == '\0') text.remove_suffix(1);
    return std::string(text);
  }

  /// Of a sequence whose elements take so many bytes at least.
  std::size_t count(std::size_t element_bytes) {
    const auto count = number<std::uint32_t>();
    if (count > reader_.left() / element_bytes) reader_.fail();
    return reader_.is_ok() ? count : 0;
  }

  std::vector<float> floats() {
    std::vector<float> values(count(sizeof(float)));
    for (float& value : values) value = number<float>();
    return values;
  }

  void skip_floats() {
    const std::size_t floats = count(sizeof(float));
    if (floats > 0) align(sizeof(float));
    reader_.take(floats * sizeof(float));
  }

  Bytes bytes() { return reader_.take(number<std::uint32_t>()); }

  Header header() {
    constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
    if (!is_cdr()) number<std::uint32_t>();  // sequence
    const std::int64_t seconds =
        is_cdr() ? number<std::int32_t>() : static_cast<std::int64_t>(number<std::uint32_t>());
    const auto nanoseconds = number<std::uint32_t>();
    return {kNanosecondsPerSecond * seconds + nanoseconds, frame()};
  }

  std::string frame() {
    std::string frame = text();
    if (frame.starts_with('/')) frame.erase(0, 1);
    return frame;
  }

  Transform transform() {
    Transform transform;
    for (int i = 0; i < 3; ++i) transform.translation_m[i] = number<double>();
    for (int i = 0; i < 4; ++i) transform.rotation.coeffs()[i] = number<double>();  // x, y, z, w
    return transform;
  }

  bool is_ok() const { return reader_.is_ok(); }
  std::size_t left() const { return reader_.left(); }

 private:
  void read_encapsulation() {
    constexpr std::size_t kEncapsulationBytes = 4;
    constexpr std::uint8_t kBigEndian = 0x00;
    constexpr std::uint8_t kLittleEndian = 0x01;
    constexpr std::uint8_t kBigEndian2 = 0x06;
    constexpr std::uint8_t kLittleEndian2 = 0x07;
    const Bytes head = reader_.take(kEncapsulationBytes);
    if (head.empty() || head[0] != 0) return reader_.fail();
    const std::uint8_t form = head[1];
    if (form != kBigEndian && form != kLittleEndian && form != kBigEndian2 &&
        form != kLittleEndian2)
      return reader_.fail();
    most_alignment_ = form >= kBigEndian2 ? 4 : 8;
    const bool is_little = form == kLittleEndian || form == kLittleEndian2;
    reader_ = ByteReader(reader_.rest(), is_little ? std::endian::little : std::endian::big);
  }

  bool is_cdr() const { return most_alignment_ > 0; }

  void align(std::size_t size) {
    if (!is_cdr()) return;
    const std::size_t alignment = std::min(size, most_alignment_);
    const std::size_t beyond = reader_.position() % alignment;
    if (beyond > 0) reader_.take(alignment - beyond);
  }

  ByteReader reader_;
  std::size_t most_alignment_ = 0;  ///< 0: ROS 1.
};

/// Why a pose cannot be used; empty if it can. Drivers that never fill in a rotation send zeros.
std::string_view fault_of(const Transform& transform) {
  constexpr double kMost = 1e7;
  constexpr double kLeastNorm = 1e-6;
  const double norm = transform.rotation.norm();
  if (!transform.translation_m.allFinite() ||
      transform.translation_m.cwiseAbs().maxCoeff() >= kMost)
    return "its position is not finite or beyond 10,000 km";
  if (!std::isfinite(norm)) return "its quaternion is not finite";
  if (norm < kLeastNorm) return "its quaternion is all zeros";
  return {};
}

/// Rounding of a unit quaternion is left as it is: the last digits of the heading depend on it.
void normalize(Transform& transform) {
  constexpr double kRounding = 1e-6;
  if (std::abs(transform.rotation.norm() - 1.0) > kRounding) transform.rotation.normalize();
}

OdometryMessage read_odometry(Fields& fields) {
  OdometryMessage odometry;
  odometry.header = fields.header();
  odometry.child_frame = fields.frame();
  odometry.pose = fields.transform();
  return odometry;
}

/// The first echo of each beam, 0 where there is none.
std::vector<float> first_echoes(Fields& fields) {
  std::vector<float> range_m(fields.count(sizeof(std::uint32_t)));
  for (float& range : range_m) {
    const std::vector<float> echoes = fields.floats();
    range = echoes.empty() ? 0.0F : echoes.front();
  }
  return range_m;
}

struct KnownType {
  std::string_view name;
  std::string_view md5;
  MessageKind kind;
};

constexpr std::array<KnownType, 7> kKnownTypes = {{
    {"sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369", MessageKind::kLaserScan},
    {"sensor_msgs/MultiEchoLaserScan", "6fefb0c6da89d7c8abe4b339f5c2f8fb", MessageKind::kMultiEcho},
    {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7", MessageKind::kOdometry},
    {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec", MessageKind::kTransforms},
    {"tf/tfMessage", "94810edda583a504dfda3829e70d7eec", MessageKind::kTransforms},
    {"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2", MessageKind::kImu},
    {"sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181", MessageKind::kPointCloud},
}};

/// Where a coordinate is in a point, and of which type.
struct PointField {
  std::size_t offset = 0;
  std::size_t size = 0;  ///< 4: float, 8: double, 0: not there.
};

double coordinate(Bytes point, const PointField& field, std::endian order) {
  ByteReader reader(point.subspan(field.offset), order);
  return field.size == sizeof(float) ? static_cast<double>(reader.number<float>())
                                     : reader.number<double>();
}

}  // namespace

MessageKind kind_of(const Channel& channel) {
  if (channel.serialization == Serialization::kOther) return MessageKind::kOther;
  for (const KnownType& known : kKnownTypes) {
    const bool is_of_its_definition =
        channel.md5.empty() || channel.md5 == "*" || channel.md5 == known.md5;
    if (channel.type == known.name && is_of_its_definition) return known.kind;
  }
  return MessageKind::kOther;
}

std::optional<LaserScanMessage> parse_laser_scan(const RawMessage& message) {
  Fields fields(message);
  LaserScanMessage scan;
  scan.header = fields.header();
  scan.first_beam_rad = fields.number<float>();
  scan.last_beam_rad = fields.number<float>();
  scan.beam_step_rad = fields.number<float>();
  fields.number<float>();  // time from beam to beam
  fields.number<float>();  // time from scan to scan
  scan.least_range_m = fields.number<float>();
  scan.most_range_m = fields.number<float>();
  scan.range_m =
      kind_of(*message.channel) == MessageKind::kMultiEcho ? first_echoes(fields) : fields.floats();
  if (!fields.is_ok() || scan.range_m.size() > kMostBeams) return std::nullopt;
  return scan;
}

std::optional<OdometryMessage> parse_odometry(const RawMessage& message) {
  Fields fields(message);
  OdometryMessage odometry = read_odometry(fields);
  if (!fields.is_ok() || !fault_of(odometry.pose).empty()) return std::nullopt;
  normalize(odometry.pose);
  return odometry;
}

std::optional<std::vector<TransformMessage>> parse_transforms(const RawMessage& message) {
  constexpr std::size_t kLeastBytes = 12 + 4 + 7 * sizeof(double);
  Fields fields(message);
  std::vector<TransformMessage> transforms;
  const std::size_t count = std::min(fields.count(kLeastBytes), kMostTransforms);
  for (std::size_t i = 0; i < count && fields.is_ok(); ++i) {
    TransformMessage transform;
    transform.header = fields.header();
    transform.child_frame = fields.frame();
    transform.parent_from_child = fields.transform();
    if (!fields.is_ok() || !fault_of(transform.parent_from_child).empty()) continue;
    normalize(transform.parent_from_child);
    transforms.push_back(std::move(transform));
  }
  if (!fields.is_ok()) return std::nullopt;
  return transforms;
}

std::optional<ImuMessage> parse_imu(const RawMessage& message) {
  Fields fields(message);
  ImuMessage imu;
  imu.header = fields.header();
  constexpr int kNumbersBeforeYawRate = 4 + 9 + 2;
  for (int i = 0; i < kNumbersBeforeYawRate; ++i) fields.number<double>();
  imu.yaw_rate_radps = fields.number<double>();
  if (!fields.is_ok() || !std::isfinite(imu.yaw_rate_radps)) return std::nullopt;
  return imu;
}

std::optional<PointCloudMessage> parse_point_cloud(const RawMessage& message) {
  constexpr std::size_t kLeastFieldBytes = 13;
  constexpr std::uint8_t kFloat = 7;
  constexpr std::uint8_t kDouble = 8;
  Fields fields(message);
  PointCloudMessage cloud;
  cloud.header = fields.header();
  const std::uint64_t height = fields.number<std::uint32_t>();
  const std::uint64_t width = fields.number<std::uint32_t>();
  std::array<PointField, 3> coordinates;
  const std::size_t field_count = fields.count(kLeastFieldBytes);
  for (std::size_t i = 0; i < field_count && fields.is_ok(); ++i) {
    const std::string name = fields.text();
    const std::size_t offset = fields.number<std::uint32_t>();
    const auto type = fields.number<std::uint8_t>();
    fields.number<std::uint32_t>();  // count
    if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') continue;
    coordinates[static_cast<std::size_t>(name[0] - 'x')] = {offset, type == kFloat ? sizeof(float)
                                                                    : type == kDouble
                                                                        ? sizeof(double)
                                                                        : 0};
  }
  const std::endian order =
      fields.number<std::uint8_t>() != 0 ? std::endian::big : std::endian::little;
  const std::size_t point_bytes = fields.number<std::uint32_t>();
  const std::size_t row_bytes = fields.number<std::uint32_t>();
  const Bytes data = fields.bytes();
  if (!fields.is_ok() || point_bytes == 0) return std::nullopt;
  if (height > 1 && row_bytes < width * point_bytes)
    return std::nullopt;  // rows that overlap would be read again and again
  for (const PointField& field : coordinates) {
    if (field.size == 0 || field.offset + field.size > point_bytes) return std::nullopt;
  }
  for (std::uint64_t row = 0; row < height && (row == 0 || row * row_bytes < data.size()); ++row) {
    for (std::uint64_t column = 0; column < width; ++column) {
      const std::uint64_t at = row * row_bytes + column * point_bytes;
      if (at + point_bytes > data.size()) break;
      const Bytes point = data.subspan(at, point_bytes);
      const Eigen::Vector3d point_m(coordinate(point, coordinates[0], order),
                                    coordinate(point, coordinates[1], order),
                                    coordinate(point, coordinates[2], order));
      if (point_m.allFinite()) cloud.points_m.push_back(point_m.cast<float>());
    }
  }
  return cloud;
}

std::string why_refused(const RawMessage& message) {
  if (kind_of(*message.channel) == MessageKind::kOdometry) {
    Fields fields(message);
    const OdometryMessage odometry = read_odometry(fields);
    if (const auto fault = fault_of(odometry.pose); fields.is_ok() && !fault.empty())
      return std::string(fault);
  }
  return "it does not decode as " + message.channel->type;
}

}  // namespace slammot::bags
