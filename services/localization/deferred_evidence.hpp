#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/grids/evidence_grid.hpp"
#include "common/work/side_work.hpp"

namespace slammot::localization {

/// An evidence grid into which the last scan may still be on its way: matching the next one needs
/// surfels only, so the larger half of mapping can be done beside it. The only way to the grid is
/// grid(), which waits: nobody sees it half done, and it holds the same whether or not there is any
/// help.
class DeferredEvidence {
 public:
  DeferredEvidence() : DeferredEvidence(grids::EvidenceGrid(), nullptr) {}

  /// Without help (null) everything is done at once. The help must outlive this.
  explicit DeferredEvidence(grids::EvidenceGrid grid, work::SideWork* help)
      : state_(std::make_unique<State>(std::move(grid), help)) {}

  /// EvidenceGrid::prepare, beside what the caller does next, if there is help: without, it would
  /// save nothing.
  void prepare(const Eigen::Vector2d& origin_m, const std::vector<grids::Ray>& rays,
               double beam_step_rad) {
    if (state_->help == nullptr) return;
    state_->settle();
    state_->ahead.take(origin_m, rays, beam_step_rad);
    state_->is_settled = false;
    state_->has_begun_to_prepare = false;
    state_->help->begin([state = state_.get()] {
      if (std::exchange(state->has_begun_to_prepare, true)) return state->grid.go_on_preparing();
      state->grid.begin_preparing(state->ahead.origin_m, state->ahead.rays,
                                  state->ahead.beam_step_rad);
      return true;
    });
  }

  /// EvidenceGrid::integrate, perhaps beside what the caller does next.
  void integrate(const Eigen::Vector2d& origin_m, const std::vector<grids::Ray>& rays,
                 double beam_step_rad) {
    if (state_->help == nullptr) return state_->grid.integrate(origin_m, rays, beam_step_rad);
    if (state_->is_being_integrated || !state_->restored.empty() || !state_->bodies.empty())
      state_->settle();
    state_->labelled.take(origin_m, rays, beam_step_rad);
    state_->is_settled = false;
    state_->is_being_integrated = true;
    state_->help->begin([state = state_.get()] {
      state->grid.integrate(state->labelled.origin_m, state->labelled.rays,
                            state->labelled.beam_step_rad);
      return false;
    });
  }

  /// EvidenceGrid::restore_stationary, after the scans that were integrated before.
  void restore_stationary(const Eigen::Vector2d& point_m,
                          grids::Echo integrated_as = grids::Echo::kMoving) {
    if (state_->is_settled) return state_->grid.restore_stationary(point_m, integrated_as);
    state_->restored.push_back({point_m, integrated_as});
  }

  /// EvidenceGrid::drive_over, after the scans that were integrated before.
  void drive_over(const grids::Box& body) {
    if (state_->is_settled) return state_->grid.drive_over(body);
    state_->bodies.push_back(body);
  }

  grids::EvidenceGrid& grid() {
    state_->settle();
    return state_->grid;
  }
  const grids::EvidenceGrid& grid() const {
    state_->settle();
    return state_->grid;
  }

  work::SideWork* help() const { return state_->help; }

 private:
  struct Scan {
    Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
    std::vector<grids::Ray> rays;
    double beam_step_rad = 0.0;

    void take(const Eigen::Vector2d& from_m, const std::vector<grids::Ray>& of_scan,
              double step_rad) {
      origin_m = from_m;
      rays = of_scan;
      beam_step_rad = step_rad;
    }
  };
  struct Restored {
    Eigen::Vector2d point_m;
    grids::Echo integrated_as;
  };
  /// Stays where it is when its owner moves: the work at hand refers to it.
  struct State {
    State(grids::EvidenceGrid empty, work::SideWork* beside)
        : grid(std::move(empty)), help(beside) {}
    ~State() { settle(); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void settle() {
      if (is_settled) return;
      help->wait();
      is_settled = true;
      is_being_integrated = false;
      for (const Restored& one : restored) grid.restore_stationary(one.point_m, one.integrated_as);
      restored.clear();
      for (const grids::Box& body : bodies) grid.drive_over(body);
      bodies.clear();
    }

    grids::EvidenceGrid grid;
    work::SideWork* help;
    bool is_settled = true;
    bool is_being_integrated = false;
    bool has_begun_to_prepare = false;
    Scan ahead;                      ///< That is prepared for,
    Scan labelled;                   ///< and that is integrated: the same one, or one before it.
    std::vector<Restored> restored;  ///< To follow it,
    std::vector<grids::Box> bodies;  ///< and these.
  };
  std::unique_ptr<State> state_;
};

}  // namespace slammot::localization
