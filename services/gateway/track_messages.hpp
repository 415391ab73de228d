#pragma once

#include <set>
#include <string>
#include <string_view>

#include "common/flow/tracked_objects.hpp"
#include "foxglove.pb.h"

namespace slammot::gateway {

std::string_view name_of(flow::ObjectClass object_class);

/// Height at which viewers draw an object's top: nothing measures it.
double drawn_height_m(flow::ObjectClass object_class);

/// Confirmed tracks in map: box, velocity arrow, predicted path and label, one entity a track.
/// Deletes the tracks of `shown`, ids of the message before, that are gone.
foxglove::SceneUpdate scene_message(const flow::TrackedObjects& objects,
                                    const std::set<flow::TrackId>& shown);

/// Ids of the tracks that scene_message() draws.
std::set<flow::TrackId> drawn_tracks(const flow::TrackedObjects& objects);

/// Everything known about all tracks, tentative ones included, as JSON. Positions, velocities and
/// covariances in odom.
std::string tracks_json(const flow::TrackedObjects& objects);

}  // namespace slammot::gateway
