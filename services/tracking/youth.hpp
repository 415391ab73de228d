#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "services/tracking/body.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Keeps what was just seen of a track that is not yet confirmed; the oldest of many goes.
void keep(Track& track, std::int64_t stamp_ns, const Glimpse& glimpse, const Eigen::Matrix2d& pose_covariance_m2);

/// The track, if it has sides, as all that was kept of it tells when filtered again, by the body as it is known now: what was
/// measured of a piece of it, or of a body that was drawn otherwise, went as that did, and not as the body. The body lies as it
/// does or is turned by a quarter, whichever is likelier, by how well the sizes fit the kinds of road users and by that a body
/// goes along its length. Cost: 2 x 40 cycles of the filters, once a track or a few times.
Track relive(Track track, const TrackingConfig& config);

}  // namespace slammot::tracking
