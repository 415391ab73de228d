#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bags/frame_tree.hpp"
#include "common/bags/message_source.hpp"
#include "common/files/bag_odometry.hpp"
#include "common/files/bag_scan.hpp"
#include "common/files/log_formats.hpp"
#include "common/files/record_source.hpp"
#include "common/files/result.hpp"

namespace slammot::files {

/// A ROS bag as records in order of recording: scans of sensor_msgs/LaserScan, MultiEchoLaserScan
/// or PointCloud2; odometry of nav_msgs/Odometry or of the transforms; mountings of the transforms.
///
/// Opening reads the whole bag once and chooses topics by their content. Scans are kept if they are
/// few enough, otherwise read again. The header stamp is the record's ipc time; the time of
/// recording is its logger time.
class BagLog : public RecordSource {
 public:
  /// Fails if the file is no bag, holds no scan, or lacks a requested topic.
  static Result<std::unique_ptr<RecordSource>> open(const std::filesystem::path& path,
                                                    const RecordOptions& options);

  std::optional<CarmenRecord> next() override;
  std::uint64_t line_number() const override { return records_; }
  double fraction_read() const override;
  bool is_cut() const override { return !damage_.empty(); }
  std::string damage() const override { return damage_; }
  TopicChoice topics() const override { return choice_; }

 private:
  /// A topic of scans or clouds.
  struct ScanTopic {
    TopicCandidate candidate;
    bool is_cloud = false;
    std::int64_t first_ns = 0;        ///< Time of recording.
    std::int64_t last_ns = 0;         ///< Time of recording.
    std::uint64_t advancing = 0;      ///< Messages with a header stamp newer than all before.
    std::uint64_t log_advancing = 0;  ///< Messages recorded later than all before.
    std::int64_t newest_stamp_ns = 0;
    std::vector<std::int64_t> lags_ns;  ///< From header stamp to recording.
    bool has_wrong_sign = false;        ///< Of angle_increment.
    std::uint8_t slot = 0;              ///< Slot of its records; 0: none.
    std::optional<Mounting> mounting;
    std::optional<sensing::SpatialMounting> profile_mounting;  ///< If its beams are steep.
    bags::Transform base_from_cloud;
    CloudSlice slice;
  };
  struct StampedRate {
    std::int64_t log_time_ns = 0;
    std::int64_t stamp_ns = 0;
    double yaw_rate_radps = 0.0;
  };
  /// Messages of a topic that cannot be used.
  struct LeftOut {
    bags::MessageKind kind = bags::MessageKind::kOther;
    std::uint64_t messages = 0;
    std::string reason;  ///< Of the first one.
  };
  struct OdometryTopic {
    TopicCandidate candidate;
    std::string parent_frame;
    std::uint64_t messages = 0;
    bool moves = false;
    std::vector<BagPose> poses;
  };
  struct Scan {
    std::int64_t log_time_ns = 0;
    std::int64_t index = 0;  ///< Of the message in the bag.
    std::size_t topic = 0;
    LaserRecord record;

    MessageTimes times() const { return {log_time_ns, record.stamps.ipc_ns.value_or(0), index}; }
  };

  explicit BagLog(RecordOptions options) : options_(std::move(options)) {}

  void look_through(bags::MessageSource& messages);
  void sort_kept();
  void look_at(const bags::RawMessage& message, bags::MessageKind kind);
  void look_at_scan(const bags::RawMessage& message, bags::MessageKind kind);
  void doubt_sign(const bags::LaserScanMessage& scan, const BeamLayout& layout, ScanTopic& topic);
  void look_at_odometry(const bags::RawMessage& message);
  void look_at_imu(const bags::RawMessage& message);
  void choose_gyro();
  std::optional<CarmenRecord> next_turn_rate();
  std::size_t scan_topic(const bags::RawMessage& message, const std::string& frame);

  std::optional<Error> choose(const std::filesystem::path& path);
  std::string unusable_scans() const;
  Error no_scan(const std::filesystem::path& path) const;
  bool scans_vertically(const TopicCandidate& candidate) const;
  std::optional<std::size_t> main_scanner() const;
  void choose_scanners(std::size_t main);
  Result<std::vector<BagPose>> choose_odometry(const std::filesystem::path& path,
                                               const std::string& laser_frame);
  std::vector<BagPose> transforms_as_odometry(const std::string& laser_frame);
  std::string base_frame(const std::string& laser_frame) const;
  void mount(ScanTopic& topic, const std::string& base_frame);
  void list_candidates();
  void set_odometry_clock(std::vector<BagPose>& poses);
  BagOdometry::Clock common_clock(const std::vector<BagPose>& poses) const;
  void note(const std::string& line);
  void leave_out(const bags::RawMessage& message);

  std::optional<Scan> next_scan();
  std::optional<Scan> read_scan();
  std::optional<Scan> scan_of(const bags::RawMessage& message) const;
  CarmenRecord finished(Scan scan);

  RecordOptions options_;
  TopicChoice choice_;
  std::vector<ScanTopic> scan_topics_;
  std::vector<OdometryTopic> odometry_topics_;
  bags::FrameTree frames_;
  std::map<std::string, std::string> types_;  ///< Of all topics, for messages about missing scans.
  std::map<std::string, std::vector<StampedRate>> turn_rates_;  ///< By topic.
  std::vector<StampedRate> gyro_;                               ///< Of the topic with most of them.
  std::size_t gyro_at_ = 0;
  std::int64_t index_ = 0;                   ///< Index of the current message.
  std::map<std::string, LeftOut> left_out_;  ///< By topic.
  std::size_t kept_bytes_ = 0;
  bool all_is_kept_ = true;
  std::deque<Scan> kept_;
  std::size_t kept_at_first_ = 0;
  std::unique_ptr<bags::MessageSource> messages_;  ///< If there are too many scans to keep.
  BagOdometry odometry_;                           ///< Of the chosen topic.
  std::optional<Scan> waiting_;
  std::uint64_t records_ = 0;
  std::string damage_;
};

}  // namespace slammot::files
