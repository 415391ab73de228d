#include "common/files/bag_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "common/bags/bag.hpp"
#include "common/files/text.hpp"

namespace slammot::files {
namespace {

using bags::MessageKind;

constexpr std::size_t kMaxKeptPoses = std::size_t{1} << 20;
constexpr std::size_t kMaxScanners = 16;
constexpr double kAmbiguousShare = 0.5;  // of the best topic's coverage
constexpr double kTiltedRad = 0.1;
constexpr double kCloudSliceM = 0.2;  // above and below the sensor, if no heights are given

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

/// Coverage of a topic: scans times field of view [rad]. Of two equivalent topics plain scans are
/// preferred.
double seen(const TopicCandidate& candidate) {
  const double form = contains(candidate.type, "MultiEcho")    ? 0.9
                      : contains(candidate.type, "PointCloud") ? 1e-6
                                                               : 1.0;
  return form * static_cast<double>(candidate.messages) *
         std::min(candidate.field_of_view_rad, 2.0 * std::numbers::pi);
}

/// Topics with poses computed from scans or with ground truth, not odometry.
bool is_no_wheel_odometry(const std::string& topic, const std::string& parent_frame) {
  return contains(topic, "truth") || contains(topic, "groundtruth") || contains(topic, "gps") ||
         parent_frame == "map" || parent_frame == "world" || parent_frame == "utm";
}

double rate_hz(std::uint64_t messages, std::int64_t first_ns, std::int64_t last_ns) {
  const double span_s = 1e-9 * static_cast<double>(last_ns - first_ns);
  return messages > 1 && span_s > 0.0 ? static_cast<double>(messages - 1) / span_s : 0.0;
}

bool differ(const geometry::Pose2& a, const geometry::Pose2& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) > 1e-9 ||
         std::abs(geometry::wrap_angle(a.heading_rad - b.heading_rad)) > 1e-9;
}

std::optional<bags::LaserScanMessage> parse_scan(const bags::RawMessage& message,
                                                 MessageKind kind) {
  return kind == MessageKind::kLaserScan || kind == MessageKind::kMultiEcho
             ? bags::parse_laser_scan(message)
             : std::nullopt;
}

std::string without_slash(std::string topic) {
  if (topic.starts_with('/')) topic.erase(0, 1);
  return topic;
}

bool is_topic(const std::string& asked_for, const std::string& topic) {
  return !asked_for.empty() && without_slash(asked_for) == without_slash(topic);
}

}  // namespace

Result<std::unique_ptr<RecordSource>> BagLog::open(const std::filesystem::path& path,
                                                   const RecordOptions& options) {
  auto first_pass = bags::open_bag(path);
  if (!first_pass.messages) return Error{first_pass.fault};
  std::unique_ptr<BagLog> log(new BagLog(options));
  log->look_through(*first_pass.messages);
  if (auto fault = log->choose(path)) return *fault;
  if (!log->all_is_kept_) {
    auto second_pass = bags::open_bag(path);
    if (!second_pass.messages) return Error{second_pass.fault};
    log->messages_ = std::move(second_pass.messages);
  }
  return std::unique_ptr<RecordSource>(std::move(log));
}

void BagLog::look_through(bags::MessageSource& messages) {
  while (const auto message = messages.next()) {
    ++index_;
    types_.emplace(message->channel->topic, message->channel->type);
    look_at(*message, bags::kind_of(*message->channel));
  }
  damage_ = messages.damage();
  index_ = 0;
  sort_kept();
  kept_at_first_ = kept_.size();
  for (const auto& [topic, left_out] : left_out_)
    choice_.doubts.push_back(topic + ": " + std::to_string(left_out.messages) +
                             " messages are left out; the first: " + left_out.reason);
  choose_gyro();
}

void BagLog::look_at_imu(const bags::RawMessage& message) {
  const auto imu = bags::parse_imu(message);
  if (!imu) return leave_out(message);
  turn_rates_[message.channel->topic].push_back(
      {message.log_time_ns, imu->header.stamp_ns, imu->yaw_rate_radps});
}

void BagLog::choose_gyro() {
  if (turn_rates_.empty()) return;
  const auto most = std::ranges::max_element(turn_rates_, {},
                                             [](const auto& topic) { return topic.second.size(); });
  for (const auto& [topic, rates] : turn_rates_)
    note("imu:      " + topic + ", " + std::to_string(rates.size()) + " messages, " +
         (topic == most->first ? "turns of the odometry if they agree" : "not used"));
  gyro_ = std::move(most->second);
  turn_rates_.clear();
  std::ranges::stable_sort(gyro_, {}, &StampedRate::log_time_ns);
}

/// Recorders write in order of arrival, converters also topic by topic. Scans of one topic stay in
/// the bag's order.
void BagLog::sort_kept() {
  std::vector<std::int64_t> newest_ns(scan_topics_.size(), 0);
  for (Scan& scan : kept_)
    scan.log_time_ns = newest_ns[scan.topic] = std::max(newest_ns[scan.topic], scan.log_time_ns);
  std::ranges::stable_sort(kept_, {}, &Scan::log_time_ns);
}

void BagLog::look_at(const bags::RawMessage& message, MessageKind kind) {
  switch (kind) {
    case MessageKind::kLaserScan:
    case MessageKind::kMultiEcho:
    case MessageKind::kPointCloud: return look_at_scan(message, kind);
    case MessageKind::kOdometry: return look_at_odometry(message);
    case MessageKind::kImu: return look_at_imu(message);
    case MessageKind::kTransforms: {
      const auto transforms = bags::parse_transforms(message);
      if (!transforms) return leave_out(message);
      for (const bags::TransformMessage& transform : *transforms)
        frames_.add(transform, message.log_time_ns, index_);
      return;
    }
    case MessageKind::kOther: return;
  }
}

std::size_t BagLog::scan_topic(const bags::RawMessage& message, const std::string& frame) {
  const auto known = std::ranges::find_if(scan_topics_, [&](const ScanTopic& topic) {
    return topic.candidate.topic == message.channel->topic;
  });
  if (known != scan_topics_.end()) return static_cast<std::size_t>(known - scan_topics_.begin());
  ScanTopic topic;
  topic.candidate.topic = message.channel->topic;
  topic.candidate.type = message.channel->type;
  topic.candidate.frame = frame;
  topic.first_ns = message.log_time_ns;
  scan_topics_.push_back(std::move(topic));
  return scan_topics_.size() - 1;
}

void BagLog::look_at_scan(const bags::RawMessage& message, MessageKind kind) {
  if (kind == MessageKind::kPointCloud) {
    // A cloud that is not selected needs no parsing: its first message gives the frame.
    const auto known = std::ranges::find_if(scan_topics_, [&](const ScanTopic& topic) {
      return topic.candidate.topic == message.channel->topic;
    });
    const auto cloud =
        known == scan_topics_.end() ? bags::parse_point_cloud(message) : std::nullopt;
    if (known == scan_topics_.end() && !cloud) return leave_out(message);
    ScanTopic& topic = scan_topics_[cloud ? scan_topic(message, cloud->header.frame)
                                          : static_cast<std::size_t>(known - scan_topics_.begin())];
    topic.is_cloud = true;
    topic.candidate.field_of_view_rad = 2.0 * std::numbers::pi;
    topic.candidate.beams = topic.slice.beams;
    ++topic.candidate.messages;
    // the header of a cloud is not parsed
    topic.advancing = topic.log_advancing += message.log_time_ns > topic.last_ns ? 1 : 0;
    topic.last_ns = topic.newest_stamp_ns = std::max(topic.last_ns, message.log_time_ns);
    return;
  }
  const auto scan = parse_scan(message, kind);
  auto record = scan ? record_of(*scan) : std::nullopt;
  if (!record) return leave_out(message);
  const std::size_t index = scan_topic(message, scan->header.frame);
  ScanTopic& topic = scan_topics_[index];
  ++topic.candidate.messages;
  doubt_sign(*scan, *record->layout, topic);
  topic.advancing += scan->header.stamp_ns > topic.newest_stamp_ns ? 1 : 0;
  topic.log_advancing += message.log_time_ns > topic.last_ns ? 1 : 0;
  topic.newest_stamp_ns = std::max(topic.newest_stamp_ns, scan->header.stamp_ns);
  topic.lags_ns.push_back(message.log_time_ns - scan->header.stamp_ns);
  topic.last_ns = std::max(topic.last_ns, message.log_time_ns);
  if (topic.candidate.beams < record->range_m.size()) {
    topic.candidate.beams = record->range_m.size();
    topic.candidate.field_of_view_rad =
        std::min(2.0 * std::numbers::pi, std::abs(record->layout->beam_step_rad) *
                                             static_cast<double>(record->range_m.size()));
  }
  kept_bytes_ += sizeof(Scan) + record->range_m.size() * sizeof(float);
  all_is_kept_ = all_is_kept_ && kept_bytes_ <= options_.most_kept_bytes;
  record->stamps = {scan->header.stamp_ns, message.log_time_ns};
  if (all_is_kept_) kept_.push_back({message.log_time_ns, index_, index, std::move(*record)});
  else kept_.clear();
}

void BagLog::doubt_sign(const bags::LaserScanMessage& scan, const BeamLayout& layout,
                        ScanTopic& topic) {
  const double stated_rad = static_cast<double>(scan.beam_step_rad);
  if (topic.has_wrong_sign || stated_rad * layout.beam_step_rad >= 0.0) return;
  topic.has_wrong_sign = true;
  choice_.doubts.push_back(
      topic.candidate.topic +
      text(": the sign of angle_increment (%g rad) contradicts angle_min (%g) and angle_max (%g), "
           "which are used",
           stated_rad, static_cast<double>(scan.first_beam_rad),
           static_cast<double>(scan.last_beam_rad)));
}

void BagLog::look_at_odometry(const bags::RawMessage& message) {
  const auto odometry = bags::parse_odometry(message);
  if (!odometry) return leave_out(message);
  auto topic = std::ranges::find_if(odometry_topics_, [&](const OdometryTopic& known) {
    return known.candidate.topic == message.channel->topic;
  });
  if (topic == odometry_topics_.end()) {
    odometry_topics_.emplace_back();
    topic = odometry_topics_.end() - 1;
    topic->candidate.topic = message.channel->topic;
    topic->candidate.type = message.channel->type;
    topic->candidate.frame = odometry->child_frame;
    topic->parent_frame = odometry->header.frame;
  }
  ++topic->candidate.messages;
  const BagPose pose{{message.log_time_ns, odometry->header.stamp_ns, index_},
                     planar(odometry->pose)};
  topic->moves =
      topic->moves ||
      (!topic->poses.empty() && differ(topic->poses.front().wheel_from_base, pose.wheel_from_base));
  if (topic->poses.size() < kMaxKeptPoses) topic->poses.push_back(pose);
}

void BagLog::leave_out(const bags::RawMessage& message) {
  LeftOut& left_out = left_out_[message.channel->topic];
  if (left_out.messages++ > 0) return;
  left_out.kind = bags::kind_of(*message.channel);
  const auto scan = parse_scan(message, left_out.kind);
  left_out.reason = scan ? why_no_record(*scan) : bags::why_refused(message);
}

void BagLog::note(const std::string& line) {
  if (std::ranges::find(choice_.notes, line) == choice_.notes.end()) choice_.notes.push_back(line);
}

/// "/scan: 292 messages, the first: its angles are impossible (...)" of the topics that may be
/// used.
std::string BagLog::unusable_scans() const {
  const std::string& asked_for = options_.topics.scan_topic;
  std::string unusable;
  for (const auto& [topic, left_out] : left_out_) {
    const bool is_scan = left_out.kind == MessageKind::kLaserScan ||
                         left_out.kind == MessageKind::kMultiEcho ||
                         left_out.kind == MessageKind::kPointCloud;
    if (!is_scan || (!asked_for.empty() && !is_topic(asked_for, topic))) continue;
    unusable += unusable.empty() ? "" : "; ";
    unusable += topic + ": " + std::to_string(left_out.messages) +
                " messages, the first: " + left_out.reason;
  }
  return unusable;
}

Error BagLog::no_scan(const std::filesystem::path& path) const {
  constexpr std::size_t kMostNamed = 300;  // characters
  std::string message = path.string();
  const std::string unusable = unusable_scans();
  if (!unusable.empty()) {
    message += ": no usable laser scan: " + unusable;
  } else {
    message += ": no laser scan ";
    message += options_.topics.scan_topic.empty() ? "in the bag"
                                                  : "of the topic " + options_.topics.scan_topic;
  }
  std::string topics;
  for (const auto& [topic, type] : types_) {
    if (topics.size() >= kMostNamed) break;
    topics += topics.empty() ? "" : ", ";
    topics += topic;
    topics += " (";
    topics += type;
    topics += ')';
  }
  if (unusable.empty()) message += types_.empty() ? ", nor any message" : "; its topics: " + topics;
  if (!damage_.empty()) message += "; it is cut off or damaged: " + damage_;
  std::ranges::replace_if(
      message, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return Error{std::move(message)};
}

std::optional<Error> BagLog::choose(const std::filesystem::path& path) {
  const auto main = main_scanner();
  if (!main) return no_scan(path);
  choose_scanners(*main);
  const std::string laser_frame = scan_topics_[*main].candidate.frame;
  auto odometry = choose_odometry(path, laser_frame);
  if (!odometry) return odometry.error();
  const std::string base = base_frame(laser_frame);
  for (ScanTopic& topic : scan_topics_) mount(topic, base);
  if (!odometry->empty()) {
    set_odometry_clock(*odometry);
    const BagOdometry::Clock clock = common_clock(*odometry);
    odometry_ = {std::move(*odometry), clock};
  }
  list_candidates();
  return std::nullopt;
}

/// By the option, or by its transform to the frames it is fixed to.
bool BagLog::scans_vertically(const TopicCandidate& candidate) const {
  if (std::ranges::find(options_.topics.vertical, candidate.topic, &VerticalScanner::name) !=
      options_.topics.vertical.end())
    return true;
  const auto fixed = frames_.fixed(frames_.fixed_root(candidate.frame), candidate.frame);
  return fixed && sensing::scans_vertically(in_space(*fixed));
}

/// The requested topic, or the one with the largest coverage of the plane.
std::optional<std::size_t> BagLog::main_scanner() const {
  std::optional<std::size_t> best;
  const auto worth = [&](std::size_t i) {
    const TopicCandidate& candidate = scan_topics_[i].candidate;
    return std::pair(!scans_vertically(candidate), seen(candidate));
  };
  for (std::size_t i = 0; i < scan_topics_.size(); ++i) {
    if (is_topic(options_.topics.scan_topic, scan_topics_[i].candidate.topic)) return i;
    if (options_.topics.scan_topic.empty() && (!best || worth(i) > worth(*best))) best = i;
  }
  return best;
}

/// The main topic, and for every other frame the topic with the largest coverage: topics of one
/// frame are one scanner, filtered or converted.
void BagLog::choose_scanners(std::size_t main) {
  std::uint8_t slot = 0;
  const auto take = [&](ScanTopic& topic) {
    topic.slot = ++slot;
    topic.candidate.is_chosen = true;
  };
  take(scan_topics_[main]);
  if (scan_topics_[main].is_cloud) {
    all_is_kept_ = false;
    kept_.clear();
  }
  std::vector<ScanTopic*> others;
  for (std::size_t i = 0; i < scan_topics_.size(); ++i) {
    if (i != main && !scan_topics_[i].is_cloud) others.push_back(&scan_topics_[i]);
  }
  std::ranges::stable_sort(others, [](const ScanTopic* a, const ScanTopic* b) {
    return seen(a->candidate) > seen(b->candidate);
  });
  std::vector<std::string> frames = {scan_topics_[main].candidate.frame};
  for (ScanTopic* other : others) {
    const bool is_known = std::ranges::find(frames, other->candidate.frame) != frames.end();
    if (is_known || scan_topics_[main].is_cloud || slot >= kMaxScanners) continue;
    frames.push_back(other->candidate.frame);
    take(*other);
    if (options_.topics.scan_topic.empty() && !scans_vertically(other->candidate) &&
        seen(other->candidate) > kAmbiguousShare * seen(scan_topics_[main].candidate)) {
      note("which scanner is the main one is ambiguous: " + scan_topics_[main].candidate.topic +
           " sees most; --scan-topic " + other->candidate.topic + " selects the other");
    }
  }
}

Result<std::vector<BagPose>> BagLog::choose_odometry(const std::filesystem::path& path,
                                                     const std::string& laser_frame) {
  const std::string& asked_for = options_.topics.odometry_topic;
  if (asked_for == "none") return std::vector<BagPose>();
  const auto worth = [&](const OdometryTopic& topic) {
    const bool is_fixed_to_laser = frames_.fixed(topic.candidate.frame, laser_frame).has_value();
    return std::tuple(topic.moves, !is_no_wheel_odometry(topic.candidate.topic, topic.parent_frame),
                      is_fixed_to_laser, topic.candidate.messages);
  };
  OdometryTopic* best = nullptr;
  for (OdometryTopic& topic : odometry_topics_) {
    const bool is_meant = asked_for.empty() || is_topic(asked_for, topic.candidate.topic);
    if (is_meant && (best == nullptr || worth(topic) > worth(*best))) best = &topic;
  }
  const bool is_tf_asked_for = is_topic(asked_for, "tf");
  if (best == nullptr && !asked_for.empty() && !is_tf_asked_for)
    return Error{path.string() + ": no odometry of the topic " + asked_for};
  const bool is_wheels = best != nullptr && best->moves &&
                         !is_no_wheel_odometry(best->candidate.topic, best->parent_frame);
  if (is_tf_asked_for || (asked_for.empty() && !is_wheels)) {
    std::vector<BagPose> transforms = transforms_as_odometry(laser_frame);
    if (!transforms.empty()) return transforms;
  }
  if (best == nullptr) return std::vector<BagPose>();
  best->candidate.is_chosen = true;
  return best->poses;
}

/// First moving frame above the laser: odom above base_link. Empty if there is none.
std::vector<BagPose> BagLog::transforms_as_odometry(const std::string& laser_frame) {
  const bags::FrameTree::Edge* const edge = frames_.first_moving_above(laser_frame);
  if (edge == nullptr || is_no_wheel_odometry({}, edge->parent)) return {};
  OdometryTopic topic;
  topic.candidate.topic = "/tf";
  topic.candidate.type = "transforms of " + edge->child + " in " + edge->parent;
  topic.candidate.frame = edge->child;
  topic.candidate.messages = edge->messages;
  topic.candidate.is_chosen = true;
  topic.moves = true;
  topic.parent_frame = edge->parent;
  for (const auto& pose : edge->poses)
    topic.poses.push_back(
        {{pose.log_time_ns, pose.stamp_ns, pose.index}, planar(pose.parent_from_child)});
  return odometry_topics_.emplace_back(std::move(topic)).poses;
}

/// The child frame of odometry; without odometry the frame to which the laser is fixed, by its
/// usual names.
std::string BagLog::base_frame(const std::string& laser_frame) const {
  for (const OdometryTopic& topic : odometry_topics_) {
    const std::string& child = topic.candidate.frame;
    if (topic.candidate.is_chosen && !child.empty() && frames_.fixed(child, laser_frame))
      return child;
  }
  constexpr std::array<std::string_view, 5> kUsual = {"base_footprint", "base_link", "base",
                                                      "base_frame", "chassis"};
  for (const std::string_view usual : kUsual) {
    if (usual != laser_frame && frames_.fixed(std::string(usual), laser_frame))
      return std::string(usual);
  }
  const std::string root = frames_.fixed_root(laser_frame);
  return root == "odom" || root == "map" || root == "world" ? laser_frame : root;
}

void BagLog::mount(ScanTopic& topic, const std::string& base_frame) {
  const auto base_from_laser = frames_.fixed(base_frame, topic.candidate.frame);
  const bool is_known = base_from_laser && base_frame != topic.candidate.frame;
  if (!is_known && topic.candidate.is_chosen)
    note("no transform says where " +
         (topic.candidate.frame.empty() ? "the scanner (frame_id is empty)"
                                        : topic.candidate.frame) +
         " is on the vehicle: as the settings have it (fallback_laser_...)");
  topic.base_from_cloud = base_from_laser.value_or(bags::Transform{});
  const double height_m = topic.base_from_cloud.translation_m.z();
  topic.slice.from_m = options_.topics.cloud_from_m.value_or(height_m - kCloudSliceM);
  topic.slice.to_m = options_.topics.cloud_to_m.value_or(height_m + kCloudSliceM);
  if (!is_known || topic.is_cloud) return;
  topic.mounting = mounting_of(*base_from_laser);
  if (const auto mounting = in_space(*base_from_laser); sensing::scans_vertically(mounting)) {
    topic.profile_mounting = mounting;
    topic.mounting->is_upside_down = false;
  }
  if (topic.mounting->is_upside_down) topic.candidate.note = "upside down";
  if (topic.mounting->tilt_rad > kTiltedRad) {
    topic.candidate.note +=
        std::string(topic.candidate.note.empty() ? "" : ", ") + "tilted by " +
        std::to_string(std::lround(topic.mounting->tilt_rad * 180.0 / std::numbers::pi)) +
        " degrees";
  }
}

void BagLog::list_candidates() {
  for (ScanTopic& topic : scan_topics_) {
    topic.candidate.rate_hz = rate_hz(topic.candidate.messages, topic.first_ns, topic.last_ns);
    choice_.scanners.push_back(topic.candidate);
  }
  const auto slot_of = [&](const TopicCandidate& candidate) {
    const auto topic = std::ranges::find_if(scan_topics_, [&](const ScanTopic& known) {
      return known.candidate.topic == candidate.topic;
    });
    return topic->slot == 0 ? 256 : static_cast<int>(topic->slot);
  };
  std::ranges::stable_sort(choice_.scanners,
                           [&](const auto& a, const auto& b) { return slot_of(a) < slot_of(b); });
  for (OdometryTopic& topic : odometry_topics_) {
    if (!topic.poses.empty())
      topic.candidate.rate_hz = rate_hz(topic.poses.size(), topic.poses.front().times.log_time_ns,
                                        topic.poses.back().times.log_time_ns);
    if (!topic.moves) topic.candidate.note = "never moves";
    else if (is_no_wheel_odometry(topic.candidate.topic, topic.parent_frame))
      topic.candidate.note = "not of wheels by its name or frame";
    choice_.odometry.push_back(topic.candidate);
    topic.poses.clear();
    topic.poses.shrink_to_fit();
  }
}

std::optional<BagLog::Scan> BagLog::scan_of(const bags::RawMessage& message) const {
  const MessageKind kind = bags::kind_of(*message.channel);
  const auto topic = std::ranges::find_if(scan_topics_, [&](const ScanTopic& known) {
    return known.slot > 0 && known.candidate.topic == message.channel->topic;
  });
  if (topic == scan_topics_.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(topic - scan_topics_.begin());
  if (kind == MessageKind::kPointCloud) {
    const auto cloud = bags::parse_point_cloud(message);
    if (!cloud) return std::nullopt;
    Scan scan{message.log_time_ns, index_, index,
              record_of(*cloud, topic->base_from_cloud, topic->slice)};
    scan.record.stamps = {cloud->header.stamp_ns, message.log_time_ns};
    return scan;
  }
  const auto parsed = parse_scan(message, kind);
  auto record = parsed ? record_of(*parsed) : std::nullopt;
  if (!record) return std::nullopt;
  record->stamps = {parsed->header.stamp_ns, message.log_time_ns};
  return Scan{message.log_time_ns, index_, index, std::move(*record)};
}

std::optional<BagLog::Scan> BagLog::read_scan() {
  while (messages_) {
    const auto message = messages_->next();
    if (!message) return std::nullopt;
    ++index_;
    if (auto scan = scan_of(*message)) return scan;
  }
  return std::nullopt;
}

std::optional<BagLog::Scan> BagLog::next_scan() {
  if (!all_is_kept_) return read_scan();
  while (!kept_.empty()) {
    Scan scan = std::move(kept_.front());
    kept_.pop_front();
    if (scan_topics_[scan.topic].slot > 0) return scan;
  }
  return std::nullopt;
}

/// By that of the scans, where the two differ.
void BagLog::set_odometry_clock(std::vector<BagPose>& poses) {
  const auto main = std::ranges::find(scan_topics_, std::uint8_t{1}, &ScanTopic::slot);
  const std::int64_t ahead_ns = odometry_clock_ahead_ns(std::exchange(main->lags_ns, {}), poses);
  if (ahead_ns == 0) return;
  for (BagPose& pose : poses) pose.times.stamp_ns -= ahead_ns;
  choice_.doubts.push_back(
      text("the clock of odometry is %.3f s %s that of the scans, by the times "
           "of recording: corrected",
           1e-9 * std::abs(static_cast<double>(ahead_ns)), ahead_ns > 0 ? "ahead of" : "behind"));
}

/// Header stamps, if those of the scans advance and those of odometry are within the same hour.
/// Otherwise the time of recording, or the order in the bag if that does not advance either.
BagOdometry::Clock BagLog::common_clock(const std::vector<BagPose>& poses) const {
  constexpr double kAdvancingShare = 0.9;
  constexpr std::int64_t kSameHour_ns = 3'600'000'000'000;
  const auto main = std::ranges::find(scan_topics_, std::uint8_t{1}, &ScanTopic::slot);
  const auto advances = [&](std::uint64_t advancing) {
    return static_cast<double>(advancing + 1) >=
           kAdvancingShare * static_cast<double>(main->candidate.messages);
  };
  const bool is_common = std::abs(poses[poses.size() / 2].times.stamp_ns - main->newest_stamp_ns) <
                         kSameHour_ns + (main->last_ns - main->first_ns);
  if (advances(main->advancing) && is_common) return BagOdometry::Clock::kHeaders;
  return advances(main->log_advancing) ? BagOdometry::Clock::kRecording
                                       : BagOdometry::Clock::kOrder;
}

/// The next scan in order, with its pose.
CarmenRecord BagLog::finished(Scan scan) {
  const ScanTopic& topic = scan_topics_[scan.topic];
  scan.record.wheel_from_base = odometry_.wheel_from_base_at(scan.times());
  odometry_.note_told(scan.times());
  LaserRecord record = std::move(scan.record);
  record.slot = topic.slot;
  record.scanner = topic.candidate.topic;
  if (!topic.mounting) return record;
  record.base_from_laser = topic.mounting->base_from_laser;
  record.profile_mounting = topic.profile_mounting;
  if (topic.mounting->is_upside_down)
    record.layout = BeamLayout{-record.layout->first_beam_rad, -record.layout->beam_step_rad};
  return record;
}

/// The next reading of the gyro, if it was recorded before odometry and scan that are next.
std::optional<CarmenRecord> BagLog::next_turn_rate() {
  if (gyro_at_ == gyro_.size()) return std::nullopt;
  const StampedRate& rate = gyro_[gyro_at_];
  const bool is_before_scan = !waiting_ || rate.log_time_ns <= waiting_->log_time_ns;
  const BagPose* const odometry = odometry_.next();
  const bool is_before_odometry =
      odometry == nullptr || rate.log_time_ns <= odometry->times.log_time_ns;
  if (!is_before_scan || !is_before_odometry) return std::nullopt;
  ++gyro_at_;
  ++records_;
  return ImuRecord{rate.yaw_rate_radps, {rate.stamp_ns, rate.log_time_ns}};
}

std::optional<CarmenRecord> BagLog::next() {
  while (true) {
    if (!waiting_) waiting_ = next_scan();
    if (auto rate = next_turn_rate()) return rate;
    const BagPose* const pose = odometry_.next();
    const std::optional<MessageTimes> scan =
        waiting_ ? std::optional(waiting_->times()) : std::nullopt;
    if (pose == nullptr && !scan) return std::nullopt;
    if (pose == nullptr || (scan && !odometry_.comes_before(*pose, *scan))) {
      ++records_;
      return finished(*std::exchange(waiting_, std::nullopt));
    }
    odometry_.skip();
    if (odometry_.is_told_by(scan ? &*scan : nullptr, *pose)) continue;
    ++records_;
    return OdometryRecord{pose->wheel_from_base, {pose->times.stamp_ns, pose->times.log_time_ns}};
  }
}

double BagLog::fraction_read() const {
  if (!all_is_kept_) return messages_ ? messages_->fraction_read() : 1.0;
  return kept_at_first_ == 0
             ? 1.0
             : 1.0 - static_cast<double>(kept_.size()) / static_cast<double>(kept_at_first_);
}

}  // namespace slammot::files
