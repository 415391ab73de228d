#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"
#include "common/matching/correlative.hpp"
#include "common/matching/score_pyramid.hpp"

namespace slammot::matching {

struct WideSearchConfig {
  double min_score = 0.3;    ///< Poses with lower scores are not searched.
  double border_cost = 0.0;  ///< Cost of the prior [score] at a border of its window; grows with
                             ///< the square of the distance.
  std::size_t max_peaks = 4;
  double min_peak_ratio = 0.7;        ///< Further peaks score at least this share of the best.
  double peak_separation_m = 0.5;     ///< Further peaks differ by more than this in position
  double peak_separation_rad = 0.15;  ///< or by more than this in heading, both in the common
                                      ///< frame.
};

/// One target map of the search.
struct WideSearchTarget {
  std::shared_ptr<const ScorePyramid> pyramid;
  geometry::Pose2 target_from_source;  ///< Middle of the window.
  SearchWindow window;
  geometry::Pose2 common_from_target;  ///< Decides whether poses on different targets are the same
                                       ///< place.
  std::function<bool(double heading_rad)> may_be = {};  ///< Accepts headings target_from_source to
                                                        ///< search; empty: all in the window.
};

struct WidePeak {
  std::size_t target = 0;  ///< Index in the order of addition.
  geometry::Pose2 target_from_source;
  double score = 0.0;  ///< In [0, 1]: mean likelihood of the points.
};

/// Search for the pose of points on any of several maps: best-first branch and bound over position
/// and heading (Olson, ICRA 2009; Hess et al., ICRA 2016). Work is counted, so that the same calls
/// give the same result on any machine. Peaks come best first: an aborted search has found the best
/// ones. Poses are ordered by score minus the prior's cost, so that among similar places the
/// expected one comes first. A peak is a pose that scores no less than its 26 neighbours on the
/// search grid.
class WideSearch {
 public:
  /// points_in_source_m: preferably about their centroid, since they are rotated about the source's
  /// origin. All targets have cells of cell_m.
  WideSearch(std::vector<Eigen::Vector2f> points_in_source_m, double cell_m,
             const WideSearchConfig& config);

  /// Coarsest level that a search in this window uses; a target's pyramid may have fewer levels.
  static int useful_level(const SearchWindow& window, double cell_m);

  /// Adds a target; call before advance(). Returns the work done: cells read.
  std::uint64_t add_target(WideSearchTarget target);

  /// Expands the best blocks until done or until at least this many cells were read. Returns the
  /// number of cells read.
  std::uint64_t advance(std::uint64_t most_work);

  bool is_done() const { return is_done_; }

  /// Best first; complete only once the search is done.
  const std::vector<WidePeak>& peaks() const { return peaks_; }

 private:
  /// Shifts [column, column + 2^level) x [row, row + 2^level) and headings [heading, heading +
  /// 2^level) steps from the window's middle.
  struct Block {
    std::uint32_t bound = 0;  ///< Of score minus cost of the prior, in units of the pyramid.
    std::uint32_t target = 0;
    std::int32_t level = 0;
    std::int32_t heading = 0;
    std::int32_t column = 0;
    std::int32_t row = 0;
  };
  struct Grid {
    WideSearchTarget target = {};
    std::int32_t half_columns = 0;
    std::int32_t half_rows = 0;
    std::int32_t half_headings = 0;
    std::vector<std::int32_t> looked_at = {};  ///< Cumulative count of accepted headings before
                                               ///< each step of the window.
  };
  static bool is_after(const Block& a, const Block& b);

  const CellPoints& turned(std::uint32_t target, double heading_steps);
  std::uint32_t bound_of(const Block& block);
  std::uint32_t least_cost_of(const Block& block) const;
  bool has_heading(const Block& block) const;
  static double middle_of(const Block& block);
  void offer(const Block& block);
  void offer(const Block& block, std::uint32_t score);
  void expand(const Block& block);
  void take_leaf(const Block& leaf);
  bool may_hold_a_new_peak(const Block& block) const;
  bool is_local_maximum(const Block& leaf);
  geometry::Pose2 pose_at(const Grid& grid, double heading, double column, double row) const;

  std::vector<Eigen::Vector2f> points_m_;
  double cell_m_;
  WideSearchConfig config_;
  double reach_m_ = 0.0;           ///< Distance of the farthest point from the source's origin.
  double heading_step_rad_ = 0.0;  ///< Moves the farthest point by one cell.
  std::vector<Grid> grids_;
  std::vector<Block> queue_;  ///< Heap, best first.
  std::vector<WidePeak> peaks_;
  double least_score_ = 0.0;  ///< Blocks with a lower score are pruned.
  double least_bound_ = 0.0;  ///< Blocks with a lower score minus cost of the prior are pruned.
  bool is_done_ = false;
  std::uint64_t work_ = 0;
  CellPoints turned_;  ///< Points rotated for the target and heading [steps] of turned_for_.
  std::pair<std::uint32_t, double> turned_for_;
};

}  // namespace slammot::matching
