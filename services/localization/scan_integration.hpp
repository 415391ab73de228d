#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/memory/recycling_queue.hpp"
#include "common/sensing/echo_reach.hpp"
#include "common/sensing/scan.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/map_admission.hpp"

namespace slammot::localization {

/// A scan with its pose, as it is to be mapped.
struct ScanToMap {
  const sensing::LaserScan& scan;
  const flow::LocalizedScan& localized;
  const std::vector<geometry::Vector2>& points_in_base_m;  ///< One a beam, without the sweep's
                                                           ///< motion.
  const std::vector<geometry::Vector2>& beams_in_odom;     ///< Unit vectors, one a beam.
  const std::vector<std::size_t>& companion_beams;         ///< That end on what goes along with the
                                                           ///< vehicle; ascending.
};

/// What a call has done.
struct IntegrationCounts {
  std::uint64_t withheld_scans = 0;
  std::uint64_t fallback_integrations = 0;  ///< Without labels of tracking.
  std::uint64_t restored_points = 0;
};

/// Decides what of which scan goes into the map, and when: scans wait for labels by tracking, take
/// those of detection where these are overdue, and leave out what is unexplained where there are
/// none. Scans go into the map in their order.
class ScanIntegration {
 public:
  explicit ScanIntegration(const LocalizerConfig& config) : config_(config) {}

  /// The scan waits for its labels. The map may prepare for it.
  void remember(const ScanToMap& scan, MapAdmission admission, LocalMap& map);

  /// Forgets the scan that was remembered last.
  void forget_last() { pending_.pop_back(); }

  /// Labels by detection, used when tracking's do not come.
  void note(const flow::SegmentedScan& segmented);

  bool awaits_labels() const { return !pending_.empty(); }
  /// Whether this scan waits and no later one does.
  bool awaits_last(const sensing::LaserScan& scan) const;
  /// Whether the scan that the labels are of waits.
  bool awaits(const flow::ScanLabels& labels) const;

  /// Adds the scan, and any that still wait before it, and gives back the points that labels
  /// restore. Unknown scans are ignored.
  IntegrationCounts integrate(const flow::ScanLabels& labels, PoseTrust trust, LocalMap& map);

  /// Adds scans whose labels are overdue at the stamp.
  IntegrationCounts integrate_overdue(std::int64_t now_ns, PoseTrust trust, LocalMap& map);

  /// Adds all that waits for labels.
  IntegrationCounts integrate_all(PoseTrust trust, LocalMap& map);

  /// Adds the doubted scans: the vehicle was there all the time, and the scanner saw the ground, or
  /// traffic on all sides.
  void integrate_doubted(LocalMap& map);

  /// The vehicle was not there.
  IntegrationCounts drop_doubted();

  /// Grows with each scan that goes into the map.
  std::uint64_t integrated_scans() const { return integrated_scans_; }

 private:
  static constexpr std::size_t kScansKeptForRestoring = 80;
  struct PendingScan {
    MapAdmission admission = MapAdmission::kMapped;
    std::int64_t stamp_ns = 0;
    std::uint32_t sequence = 0;
    std::string scanner_id;
    double beam_step_rad = 0.0;
    geometry::Vector2 origin_in_odom_m;
    std::vector<grids::Ray> rays;  ///< Ends in odom; as if all stood of which an echo may go into
                                   ///< the map.
    std::vector<flow::EndCell> end_cells;
    std::vector<flow::PointLabel> fallback;  ///< By detection; empty when it has said nothing.
  };

  grids::Ray ray_of(const ScanToMap& scan, std::size_t beam, const geometry::Matrix2& turn,
                    const geometry::Vector2& origin_in_odom_m, double no_echo_free_m) const;
  static bool is_of(const PendingScan& scan, const flow::ScanLabels& labels);
  void integrate_first(const std::vector<flow::PointLabel>* labels, PoseTrust trust, LocalMap& map,
                       IntegrationCounts& counts);
  void integrate_first_without_tracking(PoseTrust trust, LocalMap& map, IntegrationCounts& counts);
  void integrate(PendingScan& scan, LocalMap& map);
  std::uint64_t restore_points(const flow::ScanLabels& labels, LocalMap& map);

  LocalizerConfig config_;
  sensing::EchoReach echo_reach_;
  std::vector<bool> may_be_drop_out_;  ///< Memory for the beams of one scan.
  memory::RecyclingQueue<PendingScan> pending_;
  std::vector<PendingScan> doubted_;
  memory::RecyclingQueue<PendingScan> integrated_{kScansKeptForRestoring};  ///< The last ones, for
                                                                            ///< points that
                                                                            ///< tracking gives
                                                                            ///< back.
  std::uint64_t integrated_scans_ = 0;
  bool labels_come_ = false;  ///< Of the scans that wait, in time.
};

}  // namespace slammot::localization
