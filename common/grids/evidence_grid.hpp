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
  double hit_log_odds = 0.85;       ///< Added where a stationary echo ended; Wang 2004, Eq. (3.12).
  double free_log_odds = 0.30;      ///< Taken off where a beam passed, once a scan and cell.
  double limit_log_odds = 5.0;      ///< No cell is surer than this, so that the world may change.
  double occupied_log_odds = 0.5;   ///< From here on a cell counts as occupied.
  double moving_gain = 0.25;        ///< Share of the missing evidence that one moving echo adds to the MO-map.
};

enum class Echo : std::uint8_t {
  kNone,        ///< The beam tells about free space only.
  kStationary,
  kMoving,
  kTooFar,      ///< To be mapped: the beam tells about the free space before it.
};

/// One beam to integrate, in the grid's frame.
struct Ray {
  Eigen::Vector2d end_m = Eigen::Vector2d::Zero();  ///< Where the echo came from, or where the free part is cut off.
  Echo echo = Echo::kNone;
};

/// The stationary-object map (SO-map) and the moving-object map (MO-map) of one window, side by side; Wang 2004, 6.3. Beside them
/// what is to be kept of the SO-map: LastingEvidence.
class EvidenceGrid {
 public:
  EvidenceGrid() = default;
  EvidenceGrid(const GridWindow& window, const EvidenceModel& model, const LastingModel& lasting = {});

  const GridWindow& window() const { return window_; }

  /// Adds one scan, rays in the order of the beams, beam_step_rad apart. Each cell changes at most once a scan, and an echo
  /// wins over a beam that passed. Where beams are not much farther apart than cells, a beam stands for what lies half way
  /// to its neighbours, as far as the shorter one goes where both meet one surface; with a step of 0 each beam tells of its
  /// own cells only.
  void integrate(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad);

  /// The larger half of integrate(), ahead of it: finds what the scan sees through, for which it need not be known which echoes
  /// are of what moves. integrate() of the same scan completes it; of another it begins anew, so that the cells are the same as
  /// without. See integrate_a_scan and complete_a_prepared_scan of the benchmark.
  void prepare(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad);

  /// prepare() in small steps, for who has other things to do between them: go_on_preparing() until it returns false.
  void begin_preparing(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad);
  bool go_on_preparing();

  /// Adds one stationary echo without its beam: a point given back by tracking. The lasting evidence has those already that were
  /// integrated as stationary.
  void restore_stationary(const Eigen::Vector2d& point_m, Echo integrated_as = Echo::kMoving);

  /// Takes as much from each occupied cell whose centre the box covers as a beam that passes does: something is there that does
  /// not stand still. The lasting evidence remembers it: LastingEvidence::drive_over.
  void drive_over(const Box& body);

  /// In steps of kLogOddsStep, positive = occupied, 0 = never seen or outside.
  int so_steps(Cell cell) const { return window_.contains(cell) ? so_[window_.index(cell)] : 0; }

  /// In [0, 255]: how often something moved here.
  std::uint8_t moving(Cell cell) const { return window_.contains(cell) ? mo_[window_.index(cell)] : std::uint8_t{0}; }

  /// Highest SO evidence within radius cells (a square) of the cell, in steps.
  int highest_so_steps(Cell cell, int radius) const;

  /// Whether any cell within radius cells (a square) of the cell is occupied.
  bool is_occupied_near(Cell cell, int radius) const { return so_steps(cell) >= occupied_steps_ || highest_so_steps(cell, radius) >= occupied_steps_; }

  /// Distance along direction (unit vector) to the first occupied cell, or max_range_m.
  double distance_to_occupied(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction, double max_range_m) const;

  /// Same evidence in another window of the same lattice: what lies in both is kept.
  EvidenceGrid moved_to(const GridWindow& window) const;

  /// Cells of the window, row-major. set_cells needs as many as the window has.
  const std::vector<std::int8_t>& so_cells() const { return so_; }
  const std::vector<std::uint8_t>& mo_cells() const { return mo_; }
  const std::vector<std::int8_t>& lasting_cells() const { return lasting_.cells(); }
  void set_cells(std::vector<std::int8_t> so, std::vector<std::uint8_t> mo, std::vector<std::int8_t> lasting);

 private:
  /// Blocks of 8 x 8 cells with a bit for each occupied one: casting a ray looks for blocks that have any, and at their bits.
  static constexpr int kBlockShift = 3;
  static constexpr std::int32_t kInBlock = (1 << kBlockShift) - 1;

  /// One bit a block of which any cell is occupied, row by row or column by column: a lane. Along a ray's lanes empty blocks
  /// are passed many at a time.
  struct BlockLanes {
    std::int32_t words_per_lane = 0;
    std::vector<std::uint64_t> words;

    BlockLanes() = default;
    BlockLanes(std::int32_t lanes, std::int32_t blocks)
        : words_per_lane((blocks >> 6) + 1), words(static_cast<std::size_t>(lanes) * static_cast<std::size_t>(words_per_lane), 0) {}
    void set(std::int32_t lane, std::int32_t block, bool is_occupied);

    /// Blocks 8 * place and on of the lane, one bit each.
    std::uint64_t eight(std::int32_t lane, std::int32_t place) const {
      return words[static_cast<std::size_t>(lane) * static_cast<std::size_t>(words_per_lane) + static_cast<std::size_t>(place >> 3)] >> (8 * (place & 7)) & 0xff;
    }

    /// Visits the occupied blocks of a lane from the first to the last, up or down, until visit(block) is true, and tells
    /// whether it ever was.
    template <typename Visit>
    bool any(std::int32_t lane, std::int32_t first, std::int32_t last, Visit visit) const;
    bool may_have_any(std::int32_t lane, std::int32_t low, std::int32_t high) const;
  };

  struct RayInCells;

  void measure_free_ways(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad);
  void measure_surely_free_ways(const std::vector<Ray>& rays);
  void outline_free_space(const Eigen::Vector2d& origin_m, std::size_t first_way, std::size_t end_way);
  void outline_surely_free(const Eigen::Vector2d& origin_m, std::size_t first_way, std::size_t end_way);
  void walk_free_way(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction, double from_m, double to_m);
  void find_echoes(const std::vector<Ray>& rays);
  void begin_finding_free_cells(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad);
  bool find_more_free_cells(const Eigen::Vector2d& origin_m);
  bool is_prepared_for(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad) const;
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
  double ray_to_occupied_in_block(const RayInCells& ray, std::int32_t block_column, std::int32_t block_row) const;
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
  std::vector<std::uint64_t> occupied_bits_;   ///< By block.
  BlockLanes rows_of_blocks_;
  BlockLanes columns_of_blocks_;
  BitRows lowest_;                             ///< Cells of the SO-map that are known to be as low as beams can make them: nearly all that a scan sees through.
  // Of the scan at hand; kept to reuse the memory.
  BitRows free_;                               ///< Cells that it passes. All clear between scans, but for one that is prepared.
  BitRows surely_free_;                        ///< Those that the beams beside pass, too; the same.
  BitRows echoed_;                             ///< Cells that an echo came from. All clear between scans.
  struct FreeWay {
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    double length_m = 0.0;
    double to_next_m = 0.0;                    ///< Free from this beam half way to the next,
    double to_previous_m = 0.0;                ///< and half way to the one before.
    double surely_m = 0.0;                     ///< So far the beams beside it pass, too.
    Eigen::Vector2d half_way = Eigen::Vector2d::Zero();  ///< Direction in the middle between this beam and the next.
  };
  std::vector<FreeWay> ways_;                  ///< By ray.
  std::size_t outlined_ways_ = 0;              ///< The first so many of them have their edges in free_.
  struct EchoedCell {
    std::int32_t column = 0;                   ///< In the window.
    std::int32_t row = 0;
    std::size_t ray = 0;
  };
  std::vector<EchoedCell> echoes_;
  // What free_ and echoes_ were prepared for, if they were.
  bool is_prepared_ = false;
  bool is_being_prepared_ = false;
  Eigen::Vector2d prepared_origin_m_ = Eigen::Vector2d::Zero();
  double prepared_step_rad_ = 0.0;
  std::vector<Ray> prepared_rays_;
};

}  // namespace slammot::grids
