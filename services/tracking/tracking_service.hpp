#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/app/repeat_watch.hpp"
#include "common/app/run_service.hpp"
#include "common/app/state_file.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/tracking/tracking_journal.hpp"

namespace slammot::tracking {

/// Follows moving objects from segmented scan to segmented scan. Keeps a journal of its state, from
/// which the next process goes on.
class TrackingService {
 public:
  struct Settings {
    TrackingConfig config;
  };
  static constexpr const char* kName = "tracking";
  static constexpr const char* kPurpose =
      "Follows moving objects, and tells what each point of a scan is.";
  static constexpr bool kIsOnePerVehicle = true;
  static constexpr bool kKeepsState = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  static void prepare(app::ServiceContext& context);

  TrackingService(app::ServiceContext& context, const Settings& settings);
  /// Leaves the newest state in the journal.
  ~TrackingService();
  TrackingService(const TrackingService&) = delete;
  TrackingService& operator=(const TrackingService&) = delete;

 private:
  /// The file of the state, and how it is known.
  struct Journal {
    app::StateFile file;
    std::optional<std::int64_t> saved_ns;  ///< Stamp of the last saved state.
    bool is_unproven = false;  ///< The state was restored, and no scan has followed it yet.
  };

  struct ScanOnTheBus {
    flow::SegmentedScan scan;
    std::int64_t published_ns = 0;  ///< The laser scan, by the system clock of its source.
  };

  /// What waits for tracks that another process has published, and these.
  struct Handover {
    bool is_awaited = true;
    std::optional<flow::TrackedObjects> tracks = {};  ///< Newest of those that came.
    std::deque<ScanOnTheBus> early_scans = {};        ///< Came before.
  };

  void take(const slammot_SegmentedScan& sample);
  void take_stored(const slammot_TrackedObjects& sample);
  void begin();
  void begin_drive(const flow::SegmentedScan& first);
  void take_up_journal();
  void take_up(const flow::TrackedObjects& stored, std::int64_t first_stamp_ns);
  bool is_newest(const flow::TrackedObjects& stored) const;
  void prove_journal(const flow::SegmentedScan& first);
  bool follows_journal(const flow::SegmentedScan& first) const;
  void answer_again(const ScanOnTheBus& repeated, const TrackingResult& last);
  void answer_what_is_owed();
  void track(const ScanOnTheBus& on_the_bus);
  void save(std::int64_t stamp_ns);
  void save_if_due(std::int64_t stamp_ns);
  void publish(const TrackingResult& result, std::int64_t scan_published_ns);

  app::ServiceContext& context_;
  TrackingConfig config_;
  Tracker tracker_;
  dds::Writer<slammot_TrackedObjects>& objects_;
  dds::Writer<slammot_ScanLabels>& labels_;
  wire::TrackedObjectsEncoder objects_encoder_;
  wire::ScanLabelsEncoder labels_encoder_;
  app::RepeatWatch repeats_;
  Journal journal_;
  std::optional<Session> session_;  ///< None before the first scan.
  Handover handover_;
};

}  // namespace slammot::tracking
