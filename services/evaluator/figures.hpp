#pragma once

#include <string>

#include "services/evaluator/report_page.hpp"

namespace slammot::evaluator {

/// Each gives the HTML of one section of the page, or nothing where what it shows is not there.

/// The map with trajectories and tracks on it.
std::string map_figure(const ReportSource& source);

/// Errors of the pose over time, and of the path over ten metres.
std::string error_figures(const ReportSource& source);

/// Time that each stage took for a scan.
std::string latency_figure(const ReportSource& source);

/// How many objects were there, found and imagined, over time; recall by class and distance; labels
/// of echoes.
std::string detection_figures(const ReportSource& source);

/// Path, speed and mode probabilities of single tracks.
std::string track_figures(const ReportSource& source);

/// Colour of a class of objects, as CSS writes it.
const char* colour_of(const std::string& object_class);

/// The trajectory's pose at exactly this stamp, or the nearest; identity for an empty trajectory.
geometry::Pose2 pose_near(const metrics::Trajectory& trajectory, std::int64_t stamp_ns);

}  // namespace slammot::evaluator
