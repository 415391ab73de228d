#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/grids/evidence_grid.hpp"
#include "services/localization/side_work.hpp"

namespace slammot::localization {

/// An evidence grid into which the last scan may still be on its way: matching the next one needs surfels only, so the
/// larger half of mapping can be done beside it. The only way to the grid is grid(), which waits: nobody sees it half done,
/// and it holds the same whether or not there is any help.
class DeferredEvidence {
 public:
  DeferredEvidence() : DeferredEvidence(grids::EvidenceGrid(), nullptr) {}

  /// Without help (null) everything is done at once. The help must outlive this.
  explicit DeferredEvidence(grids::EvidenceGrid grid, SideWork* help) : state_(std::make_unique<State>(std::move(grid), help)) {}

  /// EvidenceGrid::prepare, beside what the caller does next, if there is help: without, it would save nothing.
  void prepare(const Eigen::Vector2d& origin_m, const std::vector<grids::Ray>& rays, double beam_step_rad) {
    if (state_->help == nullptr) return;
    state_->take(origin_m, rays, beam_step_rad);
    state_->help->begin([state = state_.get()] { state->grid.prepare(state->origin_m, state->rays, state->beam_step_rad); });
  }

  /// EvidenceGrid::integrate, perhaps beside what the caller does next.
  void integrate(const Eigen::Vector2d& origin_m, const std::vector<grids::Ray>& rays, double beam_step_rad) {
    if (state_->help == nullptr) return state_->grid.integrate(origin_m, rays, beam_step_rad);
    state_->take(origin_m, rays, beam_step_rad);
    state_->help->begin([state = state_.get()] { state->grid.integrate(state->origin_m, state->rays, state->beam_step_rad); });
  }

  /// EvidenceGrid::restore_stationary, after the scans that were integrated before.
  void restore_stationary(const Eigen::Vector2d& point_m) {
    if (state_->is_settled) return state_->grid.restore_stationary(point_m);
    state_->restored_m.push_back(point_m);
  }

  grids::EvidenceGrid& grid() {
    state_->settle();
    return state_->grid;
  }
  const grids::EvidenceGrid& grid() const {
    state_->settle();
    return state_->grid;
  }

  SideWork* help() const { return state_->help; }

 private:
  /// Stays where it is when its owner moves: the work at hand refers to it.
  struct State {
    State(grids::EvidenceGrid empty, SideWork* beside) : grid(std::move(empty)), help(beside) {}
    ~State() { settle(); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void take(const Eigen::Vector2d& from_m, const std::vector<grids::Ray>& of_scan, double step_rad) {
      settle();
      origin_m = from_m;
      rays = of_scan;
      beam_step_rad = step_rad;
      is_settled = false;
    }

    void settle() {
      if (is_settled) return;
      help->wait();
      is_settled = true;
      for (const Eigen::Vector2d& point_m : restored_m) grid.restore_stationary(point_m);
      restored_m.clear();
    }

    grids::EvidenceGrid grid;
    SideWork* help;
    bool is_settled = true;
    Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();   ///< Of the scan on its way,
    std::vector<grids::Ray> rays;                         ///< as is this
    double beam_step_rad = 0.0;                           ///< and this.
    std::vector<Eigen::Vector2d> restored_m;              ///< To follow it.
  };
  std::unique_ptr<State> state_;
};

}  // namespace slammot::localization
