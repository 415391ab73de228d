#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "common/matching/wide_search.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/registration.hpp"
#include "services/loop_closing/wall_directions.hpp"

namespace slammot::loop_closing {

struct RevisitConfig {
  double search_cell_m = 0.4;     ///< Step of the search.
  double min_window_m = 2.0;      ///< Half width of the window around the expected pose that is
                                  ///< searched, at least
  double max_window_m = 30.0;     ///< and at most.
  double astray_window_m = 60.0;  ///< Half width where the heading is not known.
  double min_agreed_share = 0.9;  ///< Of the walls about which the other knows anything.
  double rival_ratio = 0.75;  ///< Another pose that is as good as this share of the best makes it
                              ///< ambiguous.
  RegistrationConfig registration;
};

/// One way in which a new submap may lie on an earlier one.
struct Hypothesis {
  flow::SubmapId from;  ///< The earlier submap.
  flow::SubmapId to;    ///< The new one.
  geometry::UncertainPose2 from_to;
  Agreement agreement;
  double score = 0.0;       ///< Of the search.
  bool has_rivals = false;  ///< Other poses fit about as well, and are not the same within the
                            ///< covariance.
  double searched_sigma_m = 0.0;  ///< How unsure the expected pose was.

  double quality() const { return agreement.agreed_share() * agreement.overlap_share(); }
};

/// Where a place may be: on this target, about the expected pose.
struct RevisitCandidate {
  Target target;
  geometry::UncertainPose2 target_from_source;  ///< As expected.
  geometry::Pose2 map_from_target;  ///< Tells whether poses on several targets are the same place.
};

/// Grids of the targets used last: those that are searched again and again are drawn once.
class PyramidCache {
 public:
  struct Drawn {
    std::shared_ptr<const matching::ScorePyramid> pyramid;
    std::uint64_t work = 0;  ///< Done for it now: cells written.
  };
  Drawn pyramid_of(const Target& target, double cell_m);

 private:
  struct Entry {
    std::vector<std::pair<flow::SubmapId, geometry::Pose2>> members = {};
    std::shared_ptr<const matching::ScorePyramid> pyramid = nullptr;
    std::uint64_t used = 0;
  };
  static bool is_of(const Entry& entry, const Target& target, double cell_m);

  std::vector<Entry> entries_;
  std::uint64_t uses_ = 0;
};

/// Search of one place on one target or on several at once, in pieces of counted work: near the
/// expected pose first, then in all of its uncertainty. All poses on one target that hold, best
/// first. The places that it was given must outlive it.
class RevisitSearch {
 public:
  RevisitSearch(const RevisitConfig& config, const Place& source,
                std::vector<RevisitCandidate> candidates);

  /// Goes on until done or until at least so much work was done (cells read). Returns how much was.
  std::uint64_t advance(std::uint64_t most_work, PyramidCache& pyramids);

  bool is_done() const { return is_done_; }
  /// Whether it is at the part that costs least and finds most.
  bool is_near() const { return !is_done_ && window_share_ < 1.0; }
  flow::SubmapId source() const { return source_->id; }
  std::uint64_t work() const { return work_; }

  /// The only target, or the first of several, and how unsure the pose on it was.
  flow::SubmapId target() const { return candidates_.front().target.members.front().place->id; }
  double searched_sigma_m() const;

  /// Hypotheses between the first member of a candidate's target and the source; those of one
  /// target are each other's rivals. Final once the search is done.
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
  double window_share_ = 1.0;  ///< Of the full window, that is searched now.
  std::size_t targets_added_ = 0;
  std::size_t peaks_judged_ = 0;
  bool is_expectation_judged_ = false;
  std::vector<Hypothesis> hypotheses_;
  std::uint64_t work_ = 0;
  bool is_done_ = false;
};

/// How well the source agrees with the target once refined from this pose, without a search.
Agreement agreement_after_refining(const RevisitConfig& config, const Target& target,
                                   const Place& source, const geometry::Pose2& target_from_source);

/// Looks for the source in the target within the uncertainty of the expected pose, to the end. All
/// poses that hold, best first; empty when it is not there.
std::vector<Hypothesis> find_revisits(const RevisitConfig& config, const Target& target,
                                      const Place& source,
                                      const geometry::UncertainPose2& expected_target_from_source);

}  // namespace slammot::loop_closing
