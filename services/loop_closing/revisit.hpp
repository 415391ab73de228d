#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "common/matching/wide_search.hpp"
#include "services/loop_closing/hypotheses.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/pyramid_cache.hpp"
#include "services/loop_closing/registration.hpp"
#include "services/loop_closing/wall_directions.hpp"

namespace slammot::loop_closing {

struct RevisitConfig {
  double max_window_m = 30.0;  ///< Greatest half width of the searched window around the expected
                               ///< pose.
  double astray_window_m = 60.0;  ///< Half width of the window with unknown heading.
  double min_agreed_share = 0.9;  ///< Of the walls that both have seen the surroundings of.
  double rival_ratio = 0.75;  ///< Another pose with at least this share of the best quality makes a
                              ///< match ambiguous.
  RegistrationConfig registration;
};

/// Step of the search for a place on one target, and cell of its grid.
double search_cell_m(const Place& source);

/// A target and the expected pose of the source on it.
struct RevisitCandidate {
  Target target;
  geometry::UncertainPose2 target_from_source;  ///< Prior.
  geometry::Pose2 map_from_target;  ///< Tells whether poses on two targets are the same place.
};

/// Search for one place on one or several targets, in pieces of counted work: first near the
/// expected pose, then in the full window. Yields all accepted poses, best first on each target.
/// The places must outlive the search.
class RevisitSearch {
 public:
  RevisitSearch(const RevisitConfig& config, const Place& source,
                std::vector<RevisitCandidate> candidates);

  /// Continues until done or until `most_work` cells were read. Returns the work done.
  std::uint64_t advance(std::uint64_t most_work, PyramidCache& pyramids);

  bool is_done() const { return is_done_; }
  /// True during the search near the expected pose, which costs least and finds most revisits.
  bool is_near_expected() const { return !is_done_ && window_share_ < 1.0; }
  flow::SubmapId source() const { return source_->id; }
  std::uint64_t work() const { return work_; }

  /// The first target, and one sigma of the expected position on it.
  flow::SubmapId target() const { return candidates_.front().target.members.front().place->id; }
  double searched_sigma_m() const;

  /// Hypotheses between the first member of a candidate's target and the source. Several on one
  /// target compete with each other. Final once the search is done.
  std::vector<Hypothesis> found() const;

 private:
  std::uint64_t add_next_target(PyramidCache& pyramids);
  void begin_search(double window_share);
  std::uint64_t judge(const matching::WidePeak& peak);
  bool is_somewhere_expected() const;

  RevisitConfig config_;
  const Place* source_;
  std::vector<RevisitCandidate> candidates_;
  geometry::Pose2 source_from_centre_;
  WallDirections walls_;  ///< Of the source.
  std::optional<matching::WideSearch> search_;
  double window_share_ = 1.0;  ///< Share of the full window that is searched now.
  std::size_t targets_added_ = 0;
  std::size_t peaks_judged_ = 0;
  bool is_expectation_judged_ = false;
  std::vector<Hypothesis> hypotheses_;
  std::uint64_t work_ = 0;
  bool is_done_ = false;
};

/// Agreement of source and target after registration from the given pose, without a search.
Agreement agreement_after_refining(const RevisitConfig& config, const Target& target,
                                   const Place& source, const geometry::Pose2& target_from_source);

/// Complete search for the source in the target within the uncertainty of the expected pose.
/// Returns all accepted poses, best first; empty if there is none.
std::vector<Hypothesis> find_revisits(const RevisitConfig& config, const Target& target,
                                      const Place& source,
                                      const geometry::UncertainPose2& expected_target_from_source);

}  // namespace slammot::loop_closing
