#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/app/state_file.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/stored_map.hpp"
#include "common/wire/submap.hpp"
#include "services/localization/drive_watch.hpp"
#include "services/localization/localizer.hpp"
#include "services/localization/saved_session.hpp"
#include "services/localization/stored_map_watch.hpp"

namespace slammot::localization {

/// Localizes the scans of one vehicle, and keeps a checkpoint to come back from.
class LocalizationService {
 public:
  struct Settings {
    LocalizerConfig config;
    bool continues_map = false;    ///< Drives go on in the map that map_store has; otherwise each
                                   ///< begins its own.
    double map_patience_s = 30.0;  ///< Without news of that map, before a drive begins its own all
                                   ///< the same.
  };
  static constexpr const char* kName = "localization";
  static constexpr const char* kPurpose =
      "Estimates the pose of the vehicle and the map around it, scan by scan.";
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App& command_line, Settings& settings);

  LocalizationService(app::ServiceContext& context, const Settings& settings);

 private:
  struct WaitingScan {
    sensing::LaserScan scan;
    std::uint64_t drive_id;
    int turns = 0;  ///< Of the service's loop: odometry had its chance so often.
  };

  void take(const slammot_LaserScan& sample);
  void take(const slammot_Odometry& sample);
  void take(const slammot_SegmentedScan& sample);
  void take(const slammot_TrackedObjects& sample);
  void take(const slammot_ScanLabels& sample);
  void take(const slammot_GraphCorrection& sample);
  void take(const slammot_StoredMap& sample);
  template <typename Value>
  bool is_good(const wire::Decoded<Value>& decoded, std::string_view topic);

  void localize_waiting();
  bool awaits_odometry(const WaitingScan& waiting) const;
  bool is_tracking_awaited() const;
  bool awaits_tracking(const WaitingScan& waiting) const;
  bool knows_map_of(const WaitingScan& waiting);
  bool is_stored_map_known();
  bool is_of_this_drive(const WaitingScan& waiting);
  void localize(const sensing::LaserScan& scan);
  void tell_whereabouts(bool was_lost, std::uint64_t astray_before);
  bool come_back(const WaitingScan& first);
  void hand_over_earlier_drive();
  void end_drive();
  void begin_drive();
  void begin_map();
  void go_on_in_stored_map();
  void correct(const flow::GraphCorrection& correction);
  void tell_whether_it_is_tied(bool is_tied);
  void add_odometry_of_new_drive();
  void save_checkpoint(std::int64_t stamp_ns);
  void withdraw_submaps();
  void publish_finished_submaps();
  void publish(const flow::Submap& submap);
  app::CommandResult finish_submap();

  app::ServiceContext& context_;
  LocalizerConfig config_;
  Localizer localizer_;
  app::StateFile checkpoint_;
  dds::Writer<slammot_LocalizedScan>& localized_scans_;
  dds::Writer<slammot_SubmapTile>& tiles_;
  wire::LocalizedScanEncoder scan_encoder_;
  wire::SubmapEncoder submap_encoder_;
  wire::GraphCorrectionAssembler corrections_;
  std::deque<WaitingScan> waiting_;
  std::deque<sensing::Odometry> recent_odometry_;  ///< In the order of arrival.
  int waited_in_vain_ = 0;  ///< Scans for which no odometry came, one after the other.
  std::int64_t newest_objects_ns_ = 0;
  std::int64_t newest_labels_ns_ = 0;
  int waited_for_tracking_in_vain_ = 0;  ///< Scans one after the other, too.
  DriveWatch drives_;
  std::optional<StoredMapWatch> stored_map_;   ///< Where drives go on in it.
  std::optional<SavedSession> earlier_drive_;  ///< From the checkpoint; its last submap may not be
                                               ///< stored.
  bool has_looked_back_ = false;               ///< For a checkpoint.
  std::optional<flow::MapId> map_id_;          ///< None before the first scan.
  flow::OdomId odom_id_;
  flow::SubmapId first_submap_;                                     ///< Of this drive.
  std::map<flow::MapId, flow::GraphCorrection> early_corrections_;  ///< Kept by the bus from before
                                                                    ///< this process.
  std::map<std::string, flow::LocalizedScan> last_published_;       ///< By scanner.
  std::map<flow::SubmapId, std::uint32_t> published_tiles_;         ///< How many.
  std::optional<std::int64_t> last_done_ns_;  ///< Newest scan that was published.
  std::optional<std::int64_t> saved_ns_;
};

}  // namespace slammot::localization
