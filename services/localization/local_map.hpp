#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/grids/evidence_grid.hpp"
#include "common/grids/surfel_map.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/byte_stream.hpp"
#include "services/localization/deferred_evidence.hpp"

namespace slammot::localization {

struct LocalMapConfig {
  double side_m = 240.0;          ///< Of the square held around the vehicle.
  double cell_size_m = 0.2;       ///< Of SO-map and MO-map.
  double surfel_size_m = 0.5;     ///< Of the cells whose echoes are averaged for matching:
                                  ///< docs/decisions/scan-matching.md.
  double new_map_after_m = 60.0;  ///< Distance from the map's centre at which a new one begins, or
  double new_map_after_travel_m = 100.0;  ///< distance travelled in it.
  double no_echo_free_m = 40.0;           ///< A beam without echo tells that this much is free.
  double free_log_odds = 0.8;             ///< With this much against it a cell counts as free.
  double end_cell_tolerance_m = 0.25;     ///< An occupied cell this near explains an echo.
  grids::EvidenceModel evidence;
  grids::LastingModel lasting;  ///< Of what becomes the submap.
};

/// The map around the vehicle in odom: SO-map, MO-map and surfels in one window that moves on when
/// the vehicle nears its edge. What has been seen since it last moved makes the submap in progress,
/// by the evidence that lasts in place of the SO-map's: docs/decisions/maps-and-submaps.md. Wang
/// 2004, sections 3.4 and 6.3.
class LocalMap {
  struct Inherited;
  static constexpr std::int64_t kNotBegun = std::numeric_limits<std::int64_t>::min();
  /// Scans of the submap in progress.
  struct Progress {
    std::int64_t first_stamp_ns = kNotBegun;
    std::int64_t last_stamp_ns = 0;
    std::uint32_t scans = 0;
  };
  /// Way of the laser, in steps larger than jitter.
  struct Odometer {
    double way_m = 0.0;
    std::optional<geometry::Vector2> counted_to_m;

    void count(const geometry::Vector2& origin_m);
  };

 public:
  LocalMap() = default;
  /// help, if any, takes over part of integrate(); it must outlive the map.
  LocalMap(const LocalMapConfig& config, const geometry::Vector2& centre_in_odom_m,
           work::SideWork* help = nullptr, flow::SubmapId first = {});

  /// Waits for what help is still doing.
  const grids::EvidenceGrid& evidence() const { return evidence_.grid(); }
  const grids::SurfelMap& surfels() const { return surfels_; }
  flow::SubmapId submap_id() const { return submap_id_; }
  const geometry::Pose2& odom_from_submap() const { return odom_from_submap_; }

  /// Lets help do what it can of integrate() ahead of it, of the same scan: what of its echoes
  /// moves need not be known yet.
  void prepare(const geometry::Vector2& origin_m, const std::vector<grids::Ray>& rays,
               double beam_step_rad);

  /// Adds one scan whose laser stood at origin_m; rays in odom, in the order of the beams. Its
  /// surfels are there on return, its evidence when anybody asks for it.
  void integrate(std::int64_t stamp_ns, const geometry::Vector2& origin_m,
                 const std::vector<grids::Ray>& rays, double beam_step_rad);

  /// Gives back a point that was held to be moving; some of those that tracking gives back never
  /// were.
  void restore_stationary(const geometry::Vector2& point_in_odom_m,
                          grids::Echo integrated_as = grids::Echo::kMoving);

  /// Where a body is that moves nothing stands.
  void drive_over(const grids::Box& body) { evidence_.drive_over(body); }

  /// What the map says about the cell in which a beam ended.
  void look_up_end(const geometry::Vector2& end_in_odom_m, flow::LocalizedBeam& beam) const;

  /// From the laser to the first occupied cell on the way to a place; max_range_m where there is
  /// none before it.
  float expected_range_m(const geometry::Vector2& origin_in_odom_m,
                         const geometry::Vector2& towards_in_odom_m, double max_range_m) const;

  /// Whether the vehicle has gone far enough for a new map.
  bool is_outgrown(const geometry::Vector2& position_in_odom_m, double travelled_m) const;

  bool has_echoes() const { return progress_.scans > 0; }

  /// The submap in progress. Pose constraints and travel are the caller's to fill in.
  flow::Submap submap() const;

  /// Moves the window to the vehicle and begins the next submap with what the last one has seen
  /// itself. What is older has drifted by now: matching against it would bend the new submap
  /// towards it, which is for loop closing to judge.
  void begin_next(const geometry::Vector2& centre_in_odom_m);

  /// Begins the next submap with nothing: where it lies to what was seen before is not known. One
  /// that has seen nothing itself becomes it. Scans since since_ns are its own, though they are not
  /// in the map.
  void begin_astray(const geometry::Vector2& centre_in_odom_m, std::int64_t since_ns);

  /// Everything from which restored() makes a map that goes on as if nothing had happened. It does
  /// not change with the map, so that another thread may write it.
  class Snapshot {
   public:
    void write(std::vector<std::byte>& bytes) const;

   private:
    friend class LocalMap;
    grids::GridWindow window_, surfel_window_;
    std::vector<std::int8_t> so_;
    std::vector<std::uint8_t> mo_;
    std::vector<std::int8_t> lasting_;
    std::vector<grids::SurfelMoments> surfels_;
    std::shared_ptr<const Inherited> inherited_;
    flow::SubmapId submap_id_;
    geometry::Pose2 odom_from_submap_;
    Progress progress_;
    Odometer odometer_;
  };

  /// memory: any earlier snapshot that nobody needs any more. snapshot_a_localizer of the
  /// benchmark.
  Snapshot snapshot(Snapshot memory) const;
  Snapshot snapshot() const { return snapshot(Snapshot()); }
  /// None when the bytes are not a map of this configuration.
  static std::optional<LocalMap> restored(const LocalMapConfig& config, ByteReader& from,
                                          work::SideWork* help = nullptr);

 private:
  /// What the window held when the submap began: a submap holds only what was seen in it.
  struct Inherited {
    std::vector<std::int8_t> so;
    std::vector<std::uint8_t> mo;
    std::vector<std::int8_t> lasting;
    grids::SurfelMap surfels;
  };

  LocalMap(const LocalMapConfig& config, const grids::GridWindow& window,
           const grids::GridWindow& surfel_lattice, work::SideWork* help);
  void forget_surfels_in_free_space();
  Inherited held() const;
  void leave_behind_what_was_not_seen();
  void put_own_cells(const grids::GridWindow& bounds, flow::Submap& submap) const;
  std::optional<flow::Surfel> own_surfel(const grids::SurfelView& surfel) const;
  geometry::Vector2 window_centre_m() const;

  LocalMapConfig config_;
  int free_steps_ = 0;          ///< free_log_odds of the configuration.
  int end_cell_tolerance_ = 0;  ///< end_cell_tolerance_m of the configuration, in cells.
  DeferredEvidence evidence_;
  grids::SurfelMap surfels_;
  std::shared_ptr<const Inherited> inherited_;
  flow::SubmapId submap_id_;
  geometry::Pose2 odom_from_submap_;
  Progress progress_;
  Odometer odometer_;
  std::vector<geometry::Vector2> stationary_m_;  ///< Of the present scan; kept for its memory.
};

}  // namespace slammot::localization
