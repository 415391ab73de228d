#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/grids/grid_window.hpp"
#include "common/work/side_work.hpp"

namespace slammot::grids {

/// Surface element of a cell: mean of its echoes and direction of the surface.
struct SurfelView {
  Cell cell;
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< Unit length; zero if the neighbourhood has
                                                     ///< no direction.
  double spread_m2 = 0.0;                            ///< Variance of the echoes along the normal.
  double weight = 0.0;       ///< Number of echoes in the mean, up to the limit.
  double own_echoes = 0.0;   ///< Number of echoes since the map was moved to this window.
  double seen_over_m = 0.0;  ///< Distance driven between the first and the last echo.
};

/// What occupies a cell, where nothing else is near.
struct LoneObject {
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  double extent_m2 = 0.0;  ///< Variance of its echoes along its greatest extent.
};

/// First and second moments of a cell's echoes about the cell's centre.
struct CellMoments {
  float weight = 0.0F;
  float x = 0.0F, y = 0.0F;               ///< Sums [m].
  float xx = 0.0F, xy = 0.0F, yy = 0.0F;  ///< Sums [m^2].
  float own_echoes = 0.0F;
  float first_seen_at_m = 0.0F, last_seen_at_m = 0.0F;  ///< Vehicle's odometer.
};

/// Moments of one cell of a map.
struct SurfelMoments {
  Cell cell;
  CellMoments moments;
};

/// Moments of stationary echoes by cell: subcell accuracy for matching in constant memory. Normals
/// come from the 3 x 3 neighbourhood, as in the normal distributions transform (Biber and Strasser
/// 2003), with shared moments so that they are continuous across cell borders.
class SurfelMap {
 public:
  SurfelMap() : SurfelMap({}, 40.0) {}
  /// weight_limit: number of echoes after which the mean is a running mean.
  SurfelMap(const GridWindow& window, double weight_limit);

  const GridWindow& window() const { return window_; }
  std::size_t capacity_in_use() const { return moments_.size(); }

  /// Adds one echo at odometer reading odometer_m; ignored outside the window. An echo at odometer
  /// 0, the start of the drive, counts as seen from everywhere: no older surface exists to compare
  /// with.
  void add(const Eigen::Vector2d& point_m, double odometer_m = 0.0) {
    add_all(std::span(&point_m, 1), odometer_m);
  }

  /// Adds echoes in sequence. Echoes of neighbouring beams are mostly in one cell, whose derived
  /// values are computed once: add_a_scan_of_361_points of the benchmark.
  void add_all(std::span<const Eigen::Vector2d> points_m, double odometer_m);

  /// Removes every surfel and keeps the memory.
  void clear();

  /// Removes the surfel of a cell.
  void erase(Cell cell);

  /// Surfel as matching needs it: SurfelView without the bookkeeping.
  struct Surface {
    Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    double spread_m2 = 0.0;
    double seen_over_m = 0.0;
  };

  /// Like nearest(), with only the fields that matching needs.
  std::optional<Surface> nearest_surface(const Eigen::Vector2d& point_m, int radius) const;

  /// The same in two steps: the first may run in several threads at once; the second computes stale
  /// surfels.
  std::size_t nearest_place(const Eigen::Vector2d& point_m, int radius) const;
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);
  Surface surface_at(std::size_t place) const;
  /// Object in the 3 x 3 cells around a surfel's cell, if the 16 cells around those are empty.
  std::optional<LoneObject> lone_object_at(std::size_t place) const;
  const Eigen::Vector2d& mean_at(std::size_t place) const { return means_m_[place + 1]; }

  /// The surfels in the 3 x 3 cells around a cell, for several points in it.
  struct Neighbours {
    std::array<std::size_t, 9> places{};
    std::array<Eigen::Vector2d, 9> means_m;
    std::size_t count = 0;

    /// As SurfelMap::nearest_place() with radius 1.
    std::size_t nearest_place(const Eigen::Vector2d& point_m) const {
      double best_m2 = std::numeric_limits<double>::infinity();
      std::size_t best = kNoPlace;
      for (std::size_t i = 0; i < count; ++i) {
        const double distance_m2 = (means_m[i] - point_m).squaredNorm();
        if (distance_m2 >= best_m2) continue;
        best_m2 = distance_m2;
        best = places[i];
      }
      return best;
    }
  };
  Neighbours neighbours_of(Cell centre) const {
    Neighbours found;
    for (std::int32_t row = -1; row <= 1; ++row) {
      for (std::int32_t column = -1; column <= 1; ++column) {
        const std::int32_t slot = slot_of({centre.column + column, centre.row + row});
        if (is_empty(slot)) continue;
        found.places[found.count] = static_cast<std::size_t>(slot);
        found.means_m[found.count++] = mean_m(slot);
      }
    }
    return found;
  }

  /// Removes every surfel with is_gone(mean_m). help (may be null) evaluates a part of them.
  template <typename Predicate>
  void erase_where(const Predicate& is_gone, work::SideWork* help = nullptr) {
    constexpr std::size_t kRanges = 8;
    is_gone_.resize(cells_.size());
    work::share_in_ranges(help, cells_.size(), kRanges, [&](std::size_t first, std::size_t end) {
      for (std::size_t place = first; place < end; ++place)
        is_gone_[place] = !is_empty(static_cast<std::int32_t>(place)) && is_gone(mean_m(place));
    });
    for (std::size_t place = 0; place < cells_.size(); ++place)
      if (is_gone_[place]) erase(cells_[place]);
  }

  /// Surfel with the nearest mean among the 3 x 3 cells around the point. If they are empty, among
  /// the cells within radius. None if there is no echo.
  std::optional<SurfelView> nearest(const Eigen::Vector2d& point_m, int radius) const;

  /// Every surfel, ordered by first sighting.
  std::vector<SurfelView> all() const;

  /// The same surfels in another window of the same lattice; counts of own echoes restart.
  SurfelMap moved_to(const GridWindow& window) const;

  /// For checkpoints: null if the cell has no echo.
  const CellMoments* moments_at(Cell cell) const;
  /// Of every surfel, ordered by first sighting. memory: any earlier result.
  std::vector<SurfelMoments> all_moments(std::vector<SurfelMoments> memory = {}) const;
  void set_moments(Cell cell, const CellMoments& moments);

 private:
  struct Shape {
    float normal_x = 0.0F, normal_y = 0.0F, spread_m2 = 0.0F;
  };

  /// Mean [m] and covariance [m^2].
  struct Spread {
    Eigen::Vector2d mean_m;
    double cxx = 0.0, cxy = 0.0, cyy = 0.0;

    double half_trace() const { return 0.5 * (cxx + cyy); }
    /// Half the difference of the eigenvalues.
    double root() const { return std::sqrt(0.25 * (cxx - cyy) * (cxx - cyy) + cxy * cxy); }
  };

  /// Number of echoes, and their sums of x, y, xx, xy and yy about the cell's centre.
  using Moments = Eigen::Matrix<double, 6, 1>;

  std::int32_t slot_of(Cell cell) const {
    return window_.contains(cell) ? slots_[window_.index(cell)] : -1;
  }
  bool is_empty(std::int32_t slot) const {
    return slot < 0 || moments_[static_cast<std::size_t>(slot)].weight <= 0.0F;
  }
  /// True if the window contains all nine cells.
  bool has_all_around(Cell cell) const {
    return window_.contains({cell.column - 1, cell.row - 1}) &&
           window_.contains({cell.column + 1, cell.row + 1});
  }
  /// Returns infinity for no slot (-1).
  const Eigen::Vector2d& mean_m(std::ptrdiff_t slot) const {
    return means_m_[static_cast<std::size_t>(slot + 1)];
  }
  const Moments& share_of(std::ptrdiff_t slot) const {
    return shares_[static_cast<std::size_t>(slot + 1)];
  }
  std::int32_t make_slot(Cell cell);
  void add_to_moments(std::size_t place, const Eigen::Vector2d& point_m, float odometer_m);
  std::int32_t nearest_slot(const Eigen::Vector2d& point_m, int radius) const;
  void mark_stale_around(Cell cell);
  Moments moments_around(Cell cell) const;
  Spread spread_around(Cell cell) const;
  void renew_shape(std::size_t place) const;
  const Shape& fresh_shape(std::size_t place) const;
  void note_mean(std::size_t place);
  std::int32_t find(const Eigen::Vector2d& point_m, int radius) const;
  SurfelView view_of(std::int32_t slot) const;

  GridWindow window_;
  float weight_limit_;
  std::vector<std::int32_t> slots_;  ///< Per cell: index in moments_, -1 for none.
  std::vector<CellMoments> moments_;
  std::vector<char> is_gone_;             ///< Working memory of erase_where().
  std::vector<Cell> cells_;               ///< Cell of each entry of moments_.
  std::vector<Eigen::Vector2d> means_m_;  ///< Mean of each entry, at index + 1; infinite if there
                                          ///< are no echoes.
  std::vector<Moments> shares_;  ///< Contribution of each entry to the normals around it, at index
                                 ///< + 1; zero if there are no echoes.
  mutable std::vector<Shape> shapes_;   ///< Computed at the first access after a change.
  mutable std::vector<char> is_stale_;  ///< Per entry, at index + 1: true if the shape must be
                                        ///< recomputed.
};

}  // namespace slammot::grids
