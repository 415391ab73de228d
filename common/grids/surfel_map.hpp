#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/grids/grid_window.hpp"
#include "common/work/side_work.hpp"

namespace slammot::grids {

/// Where a surface was seen in a cell: mean of its echoes and the direction of the surface there.
struct SurfelView {
  Cell cell;
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();   ///< Unit length; zero where the neighbourhood has no direction.
  double spread_m2 = 0.0;                             ///< Variance of the echoes along the normal.
  double weight = 0.0;                                ///< Echoes in the mean, at most the limit.
  double own_echoes = 0.0;                            ///< Echoes since the map was moved to this window.
  double seen_over_m = 0.0;                           ///< Way of the vehicle between the first and the last echo.
};

/// First and second moments of one cell's echoes about the cell's centre.
struct CellMoments {
  float weight = 0.0F;
  float x = 0.0F, y = 0.0F;                 ///< Sums [m].
  float xx = 0.0F, xy = 0.0F, yy = 0.0F;    ///< Sums [m^2].
  float own_echoes = 0.0F;
  float first_seen_at_m = 0.0F, last_seen_at_m = 0.0F;   ///< Odometer of the vehicle.
};

/// Echoes of stationary surfaces, kept as moments by cell: sub-cell accuracy for matching at constant memory.
/// The normal comes from the 3 x 3 neighbourhood, as in the normal distributions transform (Biber and Strasser 2003)
/// but shared between neighbours so that it does not jump at cell borders.
class SurfelMap {
 public:
  SurfelMap() : SurfelMap({}, 40.0) {}
  /// weight_limit: echoes after which a mean becomes a running one.
  SurfelMap(const GridWindow& window, double weight_limit);

  const GridWindow& window() const { return window_; }
  std::size_t capacity_in_use() const { return moments_.size(); }

  /// Adds one echo, seen when the vehicle's odometer stood at odometer_m; nothing happens outside the window. What is
  /// seen at 0, where the drive begins, counts as seen for ever: there is nothing older to hold it against.
  void add(const Eigen::Vector2d& point_m, double odometer_m = 0.0) { add_all(std::span(&point_m, 1), odometer_m); }

  /// Adds echoes one after the other. Those of neighbouring beams mostly fall into one cell, about which everything is
  /// computed once: see add_a_scan_of_361_points of the benchmark.
  void add_all(std::span<const Eigen::Vector2d> points_m, double odometer_m);

  /// Forgets every surface, and keeps the memory.
  void clear();

  /// Forgets the surface in a cell.
  void erase(Cell cell);

  /// A surface as matching sees it: SurfelView without the book-keeping.
  struct Surface {
    Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    double spread_m2 = 0.0;
    double seen_over_m = 0.0;
  };

  /// Like nearest(), without what matching does not need.
  std::optional<Surface> nearest_surface(const Eigen::Vector2d& point_m, int radius) const;

  /// The same in two steps, of which several may do the first at once; the second computes what has changed.
  std::size_t nearest_place(const Eigen::Vector2d& point_m, int radius) const;
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);
  Surface surface_at(std::size_t place) const;

  /// Forgets every surfel for whose mean is_gone(mean_m) holds, which help (null: none) may be asked, too.
  template <typename Predicate>
  void erase_where(const Predicate& is_gone, work::SideWork* help = nullptr) {
    constexpr std::size_t kRanges = 8;
    is_gone_.resize(cells_.size());
    work::share_in_ranges(help, cells_.size(), kRanges, [&](std::size_t first, std::size_t end) {
      for (std::size_t place = first; place < end; ++place) is_gone_[place] = !is_empty(static_cast<std::int32_t>(place)) && is_gone(mean_m(place));
    });
    for (std::size_t place = 0; place < cells_.size(); ++place)
      if (is_gone_[place]) erase(cells_[place]);
  }

  /// Surfel with its mean nearest to the point among the 3 x 3 cells around it, or, when these hold none, among the
  /// cells within radius; none when there is no echo.
  std::optional<SurfelView> nearest(const Eigen::Vector2d& point_m, int radius) const;

  /// Every surfel, in the order in which they were first seen.
  std::vector<SurfelView> all() const;

  /// Same surfels in another window of the same lattice; counts of own echoes begin anew.
  SurfelMap moved_to(const GridWindow& window) const;

  /// For checkpoints: null where there never was an echo.
  const CellMoments* moments_at(Cell cell) const;
  void set_moments(Cell cell, const CellMoments& moments);

 private:
  struct Shape {
    float normal_x = 0.0F, normal_y = 0.0F, spread_m2 = 0.0F;
  };

  /// Echoes, and their sums of x, y, xx, xy and yy about the cell's centre.
  using Moments = Eigen::Matrix<double, 6, 1>;

  std::int32_t slot_of(Cell cell) const { return window_.contains(cell) ? slots_[window_.index(cell)] : -1; }
  bool is_empty(std::int32_t slot) const { return slot < 0 || moments_[static_cast<std::size_t>(slot)].weight <= 0.0F; }
  /// Whether the window holds all nine cells.
  bool has_all_around(Cell cell) const { return window_.contains({cell.column - 1, cell.row - 1}) && window_.contains({cell.column + 1, cell.row + 1}); }
  /// Works for no slot (-1), too: infinitely far.
  const Eigen::Vector2d& mean_m(std::ptrdiff_t slot) const { return means_m_[static_cast<std::size_t>(slot + 1)]; }
  const Moments& share_of(std::ptrdiff_t slot) const { return shares_[static_cast<std::size_t>(slot + 1)]; }
  std::int32_t make_slot(Cell cell);
  void add_to_moments(std::size_t place, const Eigen::Vector2d& point_m, float odometer_m);
  std::int32_t nearest_slot(const Eigen::Vector2d& point_m, int radius) const;
  void mark_stale_around(Cell cell);
  Moments moments_around(Cell cell) const;
  void renew_shape(std::size_t place) const;
  const Shape& fresh_shape(std::size_t place) const;
  void note_mean(std::size_t place);
  std::int32_t find(const Eigen::Vector2d& point_m, int radius) const;
  SurfelView view_of(std::int32_t slot) const;

  GridWindow window_;
  float weight_limit_;
  std::vector<std::int32_t> slots_;     ///< By cell: place in moments_, -1 for none.
  std::vector<CellMoments> moments_;
  std::vector<char> is_gone_;           ///< Memory for erase_where().
  std::vector<Cell> cells_;             ///< Of each of the moments,
  std::vector<Eigen::Vector2d> means_m_;///< and, one place later, where its echoes are in the mean; infinitely far where there are none;
  std::vector<Moments> shares_;         ///< and so, of zeros where there are none, its share in the direction of the surfaces around it.
  mutable std::vector<Shape> shapes_;   ///< Computed when first looked at after a change,
  mutable std::vector<char> is_stale_;  ///< which each, one place later, has had since or not.
};

}  // namespace slammot::grids
