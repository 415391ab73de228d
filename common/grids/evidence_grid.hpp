#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/grids/bit_rows.hpp"
#include "common/grids/box.hpp"
#include "common/grids/grid_window.hpp"
#include "common/grids/lasting_evidence.hpp"

namespace slammot::grids {

struct EvidenceModel {
  double hit_log_odds = 0.85;      ///< Added at a stationary echo; Wang 2004, Eq. (3.12).
  double free_log_odds = 0.30;     ///< Subtracted where a beam passed, once a scan and cell.
  double limit_log_odds = 5.0;     ///< Limit of the absolute log-odds, so that the map can change.
  double occupied_log_odds = 0.5;  ///< A cell is occupied from this value on.
  double moving_gain = 0.25;  ///< Share of the remaining evidence (up to 1) that one moving echo
                              ///< adds to the MO-map.
};

enum class Echo : std::uint8_t {
  kNone,  ///< No echo to map: the beam only frees cells.
  kStationary,
  kMoving,
  kTooFar,  ///< Beyond the mapped range: the beam only frees the cells before the echo.
};

/// One beam to integrate, in the grid's frame.
struct Ray {
  Eigen::Vector2d end_m = Eigen::Vector2d::Zero();  ///< Position of the echo, or end of the free
                                                    ///< part.
  Echo echo = Echo::kNone;
};

/// Stationary-object map (SO-map) and moving-object map (MO-map) of one window; Wang 2004, 6.3. It
/// also holds the lasting evidence of the SO-map: LastingEvidence.
class EvidenceGrid {
 public:
  EvidenceGrid() = default;
  EvidenceGrid(const GridWindow& window, const EvidenceModel& model,
               const LastingModel& lasting = {});

  const GridWindow& window() const { return window_; }

  /// Integrates one scan; rays in the order of the beams, beam_step_rad apart. Each cell changes at
  /// most once a scan, and an echo takes precedence over a passing beam. Where beams are not much
  /// farther apart than cells, a beam represents the sector half way to its neighbours. On one
  /// surface the sector reaches as far as the shorter beam. With beam_step_rad = 0 a beam
  /// represents only the cells that it crosses.
  void integrate(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                 double beam_step_rad);

  /// Computes a scan's free cells, the larger half of integrate(), before it is known which echoes
  /// are moving. integrate() of the same scan completes it; integrate() of another scan starts
  /// again. The result is the same as without prepare(). See integrate_a_scan and
  /// complete_a_prepared_scan of the benchmark.
  void prepare(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad);

  /// prepare() in small steps, for a thread with other tasks: call go_on_preparing() until it
  /// returns false.
  void begin_preparing(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                       double beam_step_rad);
  bool go_on_preparing();

  /// Adds a restored stationary point without its beam. The lasting evidence already has the points
  /// that were integrated as stationary.
  void restore_stationary(const Eigen::Vector2d& point_m, Echo integrated_as = Echo::kMoving);

  /// Subtracts a passing beam's log-odds from each occupied cell whose centre the box covers,
  /// because a moving object is there. Also calls LastingEvidence::drive_over.
  void drive_over(const Box& body);

  /// In steps of kLogOddsStep, positive = occupied, 0 = unseen or outside.
  int so_steps(Cell cell) const { return window_.contains(cell) ? so_[window_.index(cell)] : 0; }

  /// In [0, 255]: share of sightings in motion.
  std::uint8_t moving(Cell cell) const {
    return window_.contains(cell) ? mo_[window_.index(cell)] : std::uint8_t{0};
  }

  /// Highest SO evidence within a square of +-radius cells, in steps.
  int highest_so_steps(Cell cell, int radius) const;

  /// True if any cell within a square of +-radius cells is occupied.
  bool is_occupied_near(Cell cell, int radius) const {
    return so_steps(cell) >= occupied_steps_ || highest_so_steps(cell, radius) >= occupied_steps_;
  }

  /// Distance along direction (unit vector) to the first occupied cell; max_range_m if none.
  double distance_to_occupied(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                              double max_range_m) const;

  /// The grid in another window of the same lattice; cells in both windows are kept.
  EvidenceGrid moved_to(const GridWindow& window) const;

  /// Cells of the window, row-major. set_cells needs exactly as many as the window has.
  const std::vector<std::int8_t>& so_cells() const { return so_; }
  const std::vector<std::uint8_t>& mo_cells() const { return mo_; }
  const std::vector<std::int8_t>& lasting_cells() const { return lasting_.cells(); }
  void set_cells(std::vector<std::int8_t> so, std::vector<std::uint8_t> mo,
                 std::vector<std::int8_t> lasting);

 private:
  /// Bitmap of occupied cells in blocks of 8 x 8: ray casting searches for non-empty blocks and
  /// tests their bits.
  static constexpr int kBlockShift = 3;
  static constexpr std::int32_t kInBlock = (1 << kBlockShift) - 1;

  /// One bit for each non-empty block, by row or by column (a lane). Ray casting skips many empty
  /// blocks of a lane at once.
  struct BlockLanes {
    std::int32_t words_per_lane = 0;
    std::vector<std::uint64_t> words;

    BlockLanes() = default;
    BlockLanes(std::int32_t lanes, std::int32_t blocks)
        : words_per_lane((blocks >> 6) + 1),
          words(static_cast<std::size_t>(lanes) * static_cast<std::size_t>(words_per_lane), 0) {}
    void set(std::int32_t lane, std::int32_t block, bool is_occupied);

    /// Bits of the blocks from 8 * place on in the lane.
    std::uint64_t eight(std::int32_t lane, std::int32_t place) const {
      return words[static_cast<std::size_t>(lane) * static_cast<std::size_t>(words_per_lane) +
                   static_cast<std::size_t>(place >> 3)] >>
                 (8 * (place & 7)) &
             0xff;
    }

    /// Visits the occupied blocks of a lane from first to last, in either direction, until
    /// visit(block) returns true. Returns true if any call did.
    template <typename Visit>
    bool any(std::int32_t lane, std::int32_t first, std::int32_t last, Visit visit) const;
    bool may_have_any(std::int32_t lane, std::int32_t low, std::int32_t high) const;
  };

  struct RayInCells;

  void measure_free_ways(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                         double beam_step_rad);
  void measure_surely_free_ways(const std::vector<Ray>& rays);
  void outline_free_space(const Eigen::Vector2d& origin_m, std::size_t first_way,
                          std::size_t end_way);
  void outline_surely_free(const Eigen::Vector2d& origin_m, std::size_t first_way,
                           std::size_t end_way);
  void walk_free_way(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                     double from_m, double to_m);
  void find_echoes(const std::vector<Ray>& rays);
  void begin_finding_free_cells(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                                double beam_step_rad);
  bool find_more_free_cells(const Eigen::Vector2d& origin_m);
  bool is_prepared_for(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                       double beam_step_rad) const;
  void clear_free_cells();
  void keep_echoes_out();
  void lower_free_cells();
  void lower(std::int32_t row, std::int32_t word, std::uint64_t free_cells);
  void unnote_freed(std::int32_t row, std::int32_t word, std::uint64_t free_cells);
  void raise_echoes(const std::vector<Ray>& rays);
  void raise_so(Cell cell, int steps);
  void free_occupied_in_block(const Box& box, std::int32_t block_column, std::int32_t block_row);
  void note_occupied(std::int32_t column, std::int32_t row);
  void note_all_occupied();
  void note_block(std::int32_t block_column, std::int32_t block_row, bool is_occupied);
  double ray_to_occupied_in_block(const RayInCells& ray, std::int32_t block_column,
                                  std::int32_t block_row) const;
  static std::uint64_t bit_of(std::int32_t column, std::int32_t row) {
    return std::uint64_t{1} << (((row & kInBlock) << kBlockShift) | (column & kInBlock));
  }

  GridWindow window_;
  EvidenceModel model_;
  int hit_steps_ = 0;
  int free_steps_ = 0;
  int limit_steps_ = 0;
  int occupied_steps_ = 1;
  std::int32_t block_columns_ = 0;
  std::int32_t block_rows_ = 0;
  std::vector<std::int8_t> so_;
  std::vector<std::uint8_t> mo_;
  LastingEvidence lasting_;
  std::vector<std::uint64_t> occupied_bits_;  ///< Indexed by block.
  BlockLanes rows_of_blocks_;
  BlockLanes columns_of_blocks_;
  BitRows lowest_;  ///< SO-map cells at the lower limit: most of the cells that a scan passes.
  // Working memory of one scan.
  BitRows free_;  ///< Cells that the scan passes. Clear between scans unless a scan is prepared.
  BitRows surely_free_;  ///< Cells that the neighbouring beams pass, too; cleared in the same way.
  BitRows echoed_;       ///< Cells with an echo. Clear between scans.
  struct FreeWay {
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    double length_m = 0.0;
    double to_next_m = 0.0;      ///< Free length between this beam and half way to the next;
    double to_previous_m = 0.0;  ///< the same to the previous one.
    double surely_m = 0.0;       ///< Length that the neighbouring beams pass, too.
    Eigen::Vector2d half_way = Eigen::Vector2d::Zero();  ///< Direction half way between this beam
                                                         ///< and the next.
  };
  std::vector<FreeWay> ways_;      ///< Indexed by ray.
  std::size_t outlined_ways_ = 0;  ///< Number of leading rays whose outlines are already in free_.
  struct EchoedCell {
    std::int32_t column = 0;  ///< Column in the window.
    std::int32_t row = 0;
    std::size_t ray = 0;
  };
  std::vector<EchoedCell> echoes_;
  // Input for which free_ and echoes_ were prepared, if any.
  bool is_prepared_ = false;
  bool is_being_prepared_ = false;
  Eigen::Vector2d prepared_origin_m_ = Eigen::Vector2d::Zero();
  double prepared_step_rad_ = 0.0;
  std::vector<Ray> prepared_rays_;
};

}  // namespace slammot::grids
