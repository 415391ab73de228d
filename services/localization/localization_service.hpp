#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/stored_map.hpp"
#include "services/localization/drive_gate.hpp"
#include "services/localization/drive_watch.hpp"
#include "services/localization/early_answers.hpp"
#include "services/localization/localization_service_scans.hpp"
#include "services/localization/localization_service_session.hpp"
#include "services/localization/localization_service_submaps.hpp"
#include "services/localization/localizer.hpp"
#include "services/localization/recent_odometry.hpp"
#include "services/localization/stored_map_watch.hpp"
#include "services/localization/waiting_scans.hpp"

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
    bool log_is_examined = false;  ///< Odometry of the drive was corrected when its log was opened.
    std::vector<std::uint64_t> drive_ids;  ///< Of its drives, in their order; then the clock's.
  };
  static constexpr const char* kName = "localization";
  static constexpr const char* kPurpose =
      "Estimates the pose of the vehicle and the map around it, scan by scan.";
  static constexpr bool kIsOnePerVehicle = true;
  static constexpr bool kKeepsState = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App& command_line, Settings& settings);

  static void prepare(app::ServiceContext& context);
  /// Restores the checkpoint of the leader once, for nothing: the memory of a map, some 60 MB, is
  /// this process's own when it takes over.
  static void rehearse(app::ServiceContext& context, const Settings& settings);

  LocalizationService(app::ServiceContext& context, const Settings& settings);
  /// Leaves a checkpoint of the newest scan: a standby has nothing to localize again.
  ~LocalizationService();
  LocalizationService(const LocalizationService&) = delete;
  LocalizationService& operator=(const LocalizationService&) = delete;

 private:
  struct Drive {
    std::optional<flow::MapId> map_id;  ///< None before the first scan.
    flow::OdomId odom_id;
    flow::SubmapId first_submap;
    std::optional<std::int64_t> last_done_ns;  ///< Stamp of the newest published scan.
    EarlyAnswers answers;
    bool is_back = false;  ///< From a checkpoint: the scans since then are localized again.
    /// The drive before, of the checkpoint: its last submap may not be stored.
    std::optional<SavedSession> before;
  };
  struct Corrections {
    wire::GraphCorrectionAssembler assembler;
    /// From before the first scan: the bus keeps those from before this process.
    std::map<flow::MapId, flow::GraphCorrection> early;
  };

  struct Drives {
    DriveWatch watch;                           ///< Of the scans that were localized.
    DriveGate gate;                             ///< Of those that arrive.
    std::optional<std::int64_t> last_stray_ns;  ///< By the monotonic clock.
    std::deque<std::uint64_t> ids;              ///< Of the drives to come.
    std::optional<StoredMapWatch> stored_map;   ///< In which they go on; none: each begins its own.
  };

  void read_inputs(app::ServiceContext& context);
  void take(const slammot_LaserScan& sample, const dds::SampleInfo& info);
  void take(const slammot_Odometry& sample);
  void take(const slammot_GnssFix& sample);
  void take(const slammot_CompassReading& sample);
  void take(const slammot_SegmentedScan& sample);
  void take(const slammot_TrackedObjects& sample);
  void take(const slammot_ScanLabels& sample);
  void take(const slammot_GraphCorrection& sample);
  void take(const slammot_StoredMap& sample);
  template <typename Value>
  bool is_good(const wire::Decoded<Value>& decoded, std::string_view topic);

  void expect(const flow::TrackedObjects& objects);
  void integrate(const flow::ScanLabels& labels);
  bool is_early(std::int64_t stamp_ns) const;
  void use_early_answers(const sensing::LaserScan& scan);
  void localize_waiting();
  Awaited awaited() const;
  void localize(const WaitingScan& waiting);
  void tell_whereabouts(bool was_lost, std::uint64_t astray_before);
  void tell_of_lateness(std::uint64_t retimed_before) const;
  void tell_of_factors(std::uint64_t recalibrated_before) const;
  void tell_of_floor(const std::string& scanner_id) const;
  void publish_finished_submaps();
  app::CommandResult finish_submap();

  // Drives: localization_service_drives.cpp.
  void admit(DriveGate::Verdict verdict);
  void tell_of_strays(const std::vector<WaitingScan>& strays);
  bool knows_map_of(const WaitingScan& waiting);
  bool is_stored_map_known();
  bool is_of_this_drive(const WaitingScan& waiting);
  bool come_back(const WaitingScan& first);
  bool return_to_saved_drive(const WaitingScan& first);
  void take_up(const SavedSession& session);
  void hand_over_earlier_drive();
  void end_drive();
  void begin_drive();
  flow::OdomId new_id();
  void begin_map();
  void go_on_in_stored_map();
  void correct(const flow::GraphCorrection& correction);
  void tell_whether_it_is_tied(bool is_tied);
  SavedSession session() const;
  void save_checkpoint(std::int64_t stamp_ns);

  app::ServiceContext& context_;
  LocalizerConfig config_;
  Localizer localizer_;
  ScanPublisher scans_;
  SubmapPublisher submaps_;
  SessionFile checkpoint_;
  Corrections corrections_;
  WaitingScans waiting_;
  RecentOdometry recent_odometry_;
  Drives drives_;
  Drive drive_;
};

}  // namespace slammot::localization
