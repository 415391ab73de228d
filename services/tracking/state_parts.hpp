#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/memory/byte_stream.hpp"
#include "common/memory/state_visitor.hpp"
#include "services/tracking/competing_tracks.hpp"
#include "services/tracking/scanners.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_result.hpp"

namespace slammot::tracking {

/// The parts of each struct that a tracker keeps from scan to scan, for memory::StateVisitor. The
/// bindings do not compile where a member is missing.
struct StateParts {
  static constexpr flow::Motion largest(flow::Motion) { return flow::Motion::kStopped; }
  static constexpr flow::ObjectClass largest(flow::ObjectClass) {
    return flow::ObjectClass::kTruckOrBus;
  }
  static constexpr flow::PointLabel largest(flow::PointLabel) { return flow::PointLabel::kUnknown; }
  static constexpr Kind largest(Kind) { return Kind::kBus; }
  static constexpr Edge largest(Edge) { return Edge::kHidden; }

  // Identities and counters.
  static void visit(auto& to, memory::Like<flow::TrackId> auto& id) { to(id.value); }
  static void visit(auto& to, memory::Like<flow::MapId> auto& id) { to(id.value); }
  static void visit(auto& to, memory::Like<flow::OdomId> auto& id) { to(id.value); }
  static void visit(auto& to, memory::Like<TrackerCounters> auto& counters) {
    auto& [scans, late, begun, confirmed, merged, found_again, rejected, restored] = counters;
    to(scans, late, begun, confirmed, merged, found_again, rejected, restored);
  }

  // Kinematics.
  static void visit(auto& to, memory::Like<filters::MotionState> auto& state) {
    to(state.mean, state.covariance);
  }
  static void visit(auto& to, memory::Like<filters::ImmState> auto& state) {
    auto& [modes, probability, pairs, pair_probability] = state;
    to(modes, probability, pairs, pair_probability);
  }
  static void visit(auto& to, memory::Like<filters::StationaryProcess> auto& series) {
    auto& [age_s, weight, squared_weight, step_weight, mean_m, scatter_m2, differences_m2, last_m] =
        series;
    to(age_s, weight, squared_weight, step_weight, mean_m, scatter_m2, differences_m2, last_m);
  }
  static void visit(auto& to, memory::Like<filters::MoveStop> auto& move_stop) {
    auto& [series, stands] = move_stop;
    to(series, stands);
  }
  static void visit(auto& to, memory::Like<MeasuredCentre> auto& centre) {
    auto& [centre_m, R] = centre;
    to(centre_m, R);
  }
  static void visit(auto& to, memory::Like<GaitNoise> auto& gait) { to(gait.variance_m2); }
  static void visit(auto& to, memory::Like<Kinematics> auto& kinematics) {
    auto& [mixture, estimate, time_offset_s, move_stop, state, measured, recentred_m, innovation_m,
           gait, may_turn, cruises_only] = kinematics;
    to(mixture, estimate, time_offset_s, move_stop, state, measured, recentred_m, innovation_m,
       gait, may_turn, cruises_only);
  }
  static void visit(auto& to, memory::Like<HypothesisMotion> auto& hypothesis) {
    auto& [predicted, motion, estimate] = hypothesis;
    to(predicted, motion, estimate);
  }

  // Extent.
  static void visit(auto& to, memory::Like<Size> auto& size) {
    auto& [value_m, variance_m2] = size;
    to(value_m, variance_m2);
  }
  /// The road users are the tracker's.
  static void visit(auto& to, memory::Like<Footprint> auto& footprint) {
    auto& [heading_rad, length, width, road_users] = footprint;
    to(heading_rad, length, width);
  }
  static void visit(auto& to, memory::Like<Blob> auto& blob) {
    visit_footprint(to, blob);
    to(blob.was_seen_whole);
  }
  static void visit(auto& to, memory::Like<SizeEvidence> auto& evidence) {
    auto& [least_m, whole, missed_share] = evidence;
    to(least_m, whole, missed_share);
  }
  static void visit(auto& to, memory::Like<SizesSeen> auto& sizes) {
    auto& [length, width] = sizes;
    to(length, width);
  }
  static void visit(auto& to, memory::Like<Anchors> auto& anchors) {
    auto& [length, width] = anchors;
    to(length, width);
  }
  static void visit(auto& to, memory::Like<Box> auto& box) {
    visit_footprint(to, box);
    to(box.heading_variance_rad2, box.is_oriented, box.axis_rad, box.axis_variance_rad2,
       box.evidence, box.corner_seen, box.kind, box.anchors);
  }
  static void visit(auto& to, memory::Like<ResponseRate> auto& rate) {
    auto& [missed, asked] = rate;
    to(missed, asked);
  }
  static void visit(auto& to, memory::Like<HeadingNoise> auto& noise) { to(noise.share); }
  static void visit(auto& to, memory::Like<OutlineError> auto& error) {
    auto& [shares, echoes, scans] = error;
    to(shares, echoes, scans);
  }
  static void visit(auto& to, memory::Like<MisfitTimes> auto& misfit) {
    auto& [off_sides_s, rejected_s, oversized_s] = misfit;
    to(off_sides_s, rejected_s, oversized_s);
  }
  static void visit(auto& to, memory::Like<Extent> auto& extent) {
    auto& [outline, contour, largest_span_m, range_m, responses, heading_noise, outline_error,
           misfit] = extent;
    to(outline, contour, largest_span_m, range_m, responses, heading_noise, outline_error, misfit);
  }

  // Existence and class.
  static void visit(auto& to, memory::Like<MotionEvidence> auto& evidence) {
    auto& [moved, stood, undecided] = evidence;
    to(moved, stood, undecided);
  }
  static void visit(auto& to, memory::Like<TentativeEvidence> auto& evidence) {
    auto& [seen, in_free_space, stood] = evidence;
    to(seen, in_free_space, stood);
  }
  static void visit(auto& to, memory::Like<Consistency> auto& consistency) {
    auto& [off_sides_m, nis, weight] = consistency;
    to(off_sides_m, nis, weight);
  }
  static void visit(auto& to, memory::Like<BeamPassage> auto& passage) {
    auto& [through, met] = passage;
    to(through, met);
  }
  static void visit(auto& to, memory::Like<Travel> auto& travel) {
    auto& [travelled_m, anchor_m, claimed_m, without_progress_s, last_moving_ns] = travel;
    to(travelled_m, anchor_m, claimed_m, without_progress_s, last_moving_ns);
  }
  static void visit(auto& to, memory::Like<VelocityCheck> auto& check) {
    auto& [is_refuted, known_since_ns] = check;
    to(is_refuted, known_since_ns);
  }
  static void visit(auto& to, memory::Like<Existence> auto& existence) {
    auto& [score, confirmed, hits, motion, tentative, travel, mapped_share, consistency, passage,
           velocity_check, mean_echoes] = existence;
    to(score, confirmed, hits, motion, tentative, travel, mapped_share, consistency, passage,
       velocity_check, mean_echoes);
  }
  static void visit(auto& to, memory::Like<SpeedsSeen> auto& speeds) {
    auto& [log_likelihood, surely_mps] = speeds;
    to(log_likelihood, surely_mps);
  }
  static void visit(auto& to, memory::Like<Classification> auto& classification) {
    auto& [likeliest, probability, speeds] = classification;
    to(likeliest, probability, speeds);
  }

  // History.
  static void visit(auto& to, memory::Like<Side> auto& side) {
    auto& [heading_rad, length_m, off_m] = side;
    to(heading_rad, length_m, off_m);
  }
  /// Its points are the stored observation's.
  static void visit(auto& to, memory::Like<Observation> auto& observation) {
    auto& [points_m, laser_m, beam_step_rad, start, end, side, unanswered_share] = observation;
    to(laser_m, beam_step_rad, start, end, side, unanswered_share);
  }
  static void visit(auto& to, memory::Like<StoredObservation> auto& stored) {
    auto& [stamp_ns, points_m, observation, pose_covariance_m2] = stored;
    to(stamp_ns, points_m, observation, pose_covariance_m2);
  }
  static void visit(auto& to, memory::Like<flow::RestoredPoints> auto& points) {
    auto& [sequence, beams] = points;
    to(sequence, beams);
  }
  static void visit(auto& to, memory::Like<PastPoints> auto& past) {
    auto& [scanner, points] = past;
    to(scanner, points);
  }
  static void visit(auto& to, memory::Like<History> auto& history) {
    auto& [first_seen_ns, last_seen_ns, birth, observations, past_points, scanner, since_in_view_s,
           first_published_ns, misses, is_hidden, is_unseen, expected_passed] = history;
    to(first_seen_ns, last_seen_ns, birth, observations, past_points, scanner, since_in_view_s,
       first_published_ns, misses, is_hidden, is_unseen, expected_passed);
  }
  static void visit(auto& to, memory::Like<Track> auto& track) {
    auto& [track_id, object_id, kinematics, extent, existence, classification, history] = track;
    to(track_id, object_id, kinematics, extent, existence, classification, history);
  }

  // Scanners and place.
  /// There are thousands: in one number.
  static void visit(auto& to, memory::Like<Owner> auto& owner) {
    auto& [track_id, is_owned, is_confirmed, has_come] = owner;
    std::uint64_t word = std::uint64_t{track_id.value} | std::uint64_t{is_owned} << 32 |
                         std::uint64_t{is_confirmed} << 33 | std::uint64_t{has_come} << 34;
    to(word);
    const auto flag = [word](int bit) { return (word >> bit & 1U) != 0; };
    if constexpr (!std::is_const_v<std::remove_reference_t<decltype(owner)>>)
      owner = {{static_cast<std::uint32_t>(word)}, flag(32), flag(33), flag(34)};
  }
  static void visit(auto& to, memory::Like<EarlierScan> auto& scan) {
    auto& [stamp_ns, view, owners] = scan;
    to(stamp_ns, view, owners);
  }
  static void visit(auto& to, memory::Like<Scanner> auto& scanner) {
    auto& [scanner_id, history, restored] = scanner;
    to(scanner_id, history, restored);
  }
  static void visit(auto& to, memory::Like<KindOfBody> auto& body) {
    auto& [kind, share, length_m, length_sigma_m, width_m, width_sigma_m, log_share, askew_m] =
        body;
    to(kind, share, length_m, length_sigma_m, width_m, width_sigma_m);
    if constexpr (!std::is_const_v<std::remove_reference_t<decltype(body)>>)
      body = KindOfBody{kind, share, length_m, length_sigma_m, width_m, width_sigma_m};
  }
  static void visit(auto& to, memory::Like<RoadUsers> auto& users) {
    auto& [kinds, corner, shape_share, swing_share] = users;
    to(kinds, corner, shape_share, swing_share);
  }

 private:
  static void visit_footprint(auto& to, const Footprint& footprint) { visit(to, footprint); }
  static void visit_footprint(auto& to, Footprint& footprint) { visit(to, footprint); }
};

template <typename Parts, typename State>
void save_state(std::vector<std::byte>& bytes, const State& state) {
  memory::StateSaver saver(bytes);
  memory::StateVisitor<Parts, memory::StateSaver> visit(saver);
  visit(state);
}

/// Not ok afterwards where the bytes are no such state.
template <typename Parts, typename State>
void load_state(memory::ByteReader& from, State& state) {
  memory::StateLoader loader(from);
  memory::StateVisitor<Parts, memory::StateLoader> visit(loader);
  visit(state);
}

}  // namespace slammot::tracking
