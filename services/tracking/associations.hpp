#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/association/pairing_costs.hpp"
#include "common/flow/segmented_scan.hpp"

namespace slammot::tracking {

/// What an update makes of a track.
enum class UpdateOutcome : std::uint8_t {
  kContinues,
  kRejected,  ///< The echoes are of another object: the share is to be released.
  kConfirmable,
};

/// What one scan assigns to one track.
struct TrackShare {
  std::vector<std::uint16_t> beams;  ///< Ascending, but for one step across the seam of a scan that
                                     ///< goes all round.
  std::vector<Eigen::Vector2d> points_m;  ///< Of the beams, at the time of the track's estimate;
                                          ///< written by the update.
  flow::PointLabel label = flow::PointLabel::kUnknown;  ///< Moving if any of its segments is, else
                                                        ///< stationary if any is.
  UpdateOutcome outcome = UpdateOutcome::kContinues;    ///< Written by the update.
};

/// Which segments and beams of the current scan belong to which track.
/// Invariant: shares are in the order of the tracks; a segment belongs to at most one of them.
struct Associations {
  std::vector<TrackShare> shares;
  std::vector<std::size_t> track_of_segment;  ///< association::kUnassigned where none.

  bool is_unassigned(std::size_t segment) const {
    return track_of_segment[segment] == association::kUnassigned;
  }
  bool has_echoes(std::size_t track) const { return !shares[track].beams.empty(); }
};

/// Empties the shares, of which there must be one a track, and unassigns all segments.
void clear(Associations& associations, std::size_t segment_count);

/// Adds beams in ascending order.
void add_beams(std::vector<std::uint16_t>& beams, std::span<const std::uint16_t> more);

/// Takes everything from a track: its echoes are of another object.
void release(Associations& associations, std::size_t track);

/// Gives one track the beams of another.
void move_beams(Associations& associations, std::size_t from, std::size_t to);

/// The label that prevails: moving over stationary over unknown.
flow::PointLabel stronger(flow::PointLabel a, flow::PointLabel b);

}  // namespace slammot::tracking
