#include "services/tracking/formations.hpp"

#include <algorithm>

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using flow::TrackId;

constexpr double kAlikeForS = 1.0;         ///< Before two tracks belong together.
constexpr double kReachM = 18.0;           ///< Between neighbours in a queue.
constexpr double kMostApartMps = 1.0;      ///< Largest difference of their velocities,
constexpr double kMostApartShare = 0.15;   ///< plus this share of them.
constexpr double kSlowestMemberMps = 1.0;  ///< Of a member.
constexpr double kSharedShare = 0.9;  ///< Of the process noise, common to the members: they brake
                                      ///< for the same light.
constexpr std::size_t kMostMembers = 6;

bool may_be_member(const Track& track, const TrackingConfig& config) {
  return track.existence.confirmed && track.extent.box() != nullptr &&
         track.velocity_mps().norm() > kSlowestMemberMps * config.extent.size_scale;
}

bool go_alike(const Track& a, const Track& b, const TrackingConfig& config) {
  const double most_mps =
      kMostApartMps * config.extent.size_scale + kMostApartShare * a.velocity_mps().norm();
  return may_be_member(a, config) && may_be_member(b, config) &&
         (a.position_m() - b.position_m()).norm() < kReachM * config.extent.size_scale &&
         (a.velocity_mps() - b.velocity_mps()).norm() < most_mps;
}

Track& track_of(TrackId id, std::vector<Track>& tracks) {
  return *std::find_if(tracks.begin(), tracks.end(),
                       [id](const Track& track) { return track.track_id == id; });
}

filters::FormationMotion queue_motion() {
  return {{filters::MotionKind::kConstantAcceleration, kJerkNoiseDensity, 0.0}, kSharedShare};
}

}  // namespace

void Formations::note_pairs(const std::vector<Track>& tracks, double time_s) {
  std::map<Pair, double> alike_s;
  for (const Track& a : tracks) {
    for (const Track& b : tracks) {
      if (!(a.track_id < b.track_id)) continue;
      const auto before = alike_s_.find({a.track_id, b.track_id});
      const double so_far_s = before == alike_s_.end() ? 0.0 : before->second;
      if (!a.kinematics.measured || !b.kinematics.measured) {
        if (so_far_s > 0.0) alike_s[{a.track_id, b.track_id}] = so_far_s;  // no new evidence
      } else if (go_alike(a, b, config_)) {
        alike_s[{a.track_id, b.track_id}] = so_far_s + time_s;
      }
    }
  }
  alike_s_ = std::move(alike_s);
}

std::vector<std::vector<TrackId>> Formations::groups(const std::vector<Track>& tracks) const {
  std::vector<std::vector<TrackId>> all;
  std::vector<TrackId> taken;
  const auto is_taken = [&](TrackId id) {
    return std::find(taken.begin(), taken.end(), id) != taken.end();
  };
  for (const Track& first : tracks) {
    if (is_taken(first.track_id)) continue;
    std::vector<TrackId> group = {first.track_id};
    taken.push_back(first.track_id);
    for (std::size_t next = 0; next < group.size(); ++next) {
      for (const auto& [pair, time_s] : alike_s_) {
        if (time_s < kAlikeForS || (pair.first != group[next] && pair.second != group[next]))
          continue;
        const TrackId other = pair.first == group[next] ? pair.second : pair.first;
        if (is_taken(other) || group.size() == kMostMembers) continue;
        group.push_back(other);
        taken.push_back(other);
      }
    }
    std::sort(group.begin(), group.end());
    if (group.size() > 1) all.push_back(std::move(group));
  }
  return all;
}

Formations::Formation Formations::initiated(const std::vector<TrackId>& members,
                                            const std::vector<Track>& tracks) const {
  std::vector<filters::MotionState> states;
  states.reserve(members.size());
  for (const TrackId id : members)
    states.push_back(std::find_if(tracks.begin(), tracks.end(), [id](const Track& track) {
                       return track.track_id == id;
                     })->kinematics.estimate);
  return {members, filters::formation_of(states)};
}

void Formations::step(Formation& formation, std::vector<Track>& tracks, double time_s) const {
  formation.state = filters::predict(queue_motion(), formation.state, time_s);
  std::vector<filters::MemberFix> fixes;
  for (std::size_t i = 0; i < formation.members.size(); ++i) {
    const Track& track = track_of(formation.members[i], tracks);
    filters::formation_shift(formation.state, i, track.kinematics.recentred_m);
    if (track.kinematics.measured)
      fixes.push_back({i, track.kinematics.measured->centre_m, track.kinematics.measured->R});
  }
  formation.state = filters::update(formation.state, fixes, Matrix2d::Zero());
  for (std::size_t i = 0; i < formation.members.size(); ++i) {
    Track& track = track_of(formation.members[i], tracks);
    if (!track.kinematics.measured && !fixes.empty())
      restart_from(track.kinematics, filters::member_of(formation.state, i), config_);
  }
}

bool Formations::is_sound_with(const std::vector<Track>& tracks) const {
  const auto is_known = [&](TrackId id) {
    return std::ranges::find(tracks, id, &Track::track_id) != tracks.end();
  };
  const auto is_sound = [](const Formation& formation) {
    const auto numbers = static_cast<Eigen::Index>(6 * formation.members.size());
    const filters::FormationState& state = formation.state;
    return state.mean.size() == numbers && state.covariance.rows() == numbers &&
           state.covariance.cols() == numbers;
  };
  return std::ranges::all_of(formations_, is_sound) &&
         std::ranges::all_of(alike_s_, [&](const auto& alike) {
           return is_known(alike.first.first) && is_known(alike.first.second);
         });
}

void Formations::follow(std::vector<Track>& tracks, double time_s) {
  note_pairs(tracks, time_s);
  std::vector<Formation> now;
  for (const std::vector<TrackId>& members : groups(tracks)) {
    const auto known =
        std::find_if(formations_.begin(), formations_.end(),
                     [&](const Formation& formation) { return formation.members == members; });
    if (known == formations_.end()) {
      now.push_back(initiated(members, tracks));
      continue;
    }
    now.push_back(std::move(*known));
    step(now.back(), tracks, time_s);
  }
  formations_ = std::move(now);
}

}  // namespace slammot::tracking
