#pragma once

#include <string>

#include "services/evaluator/report_page.hpp"

namespace slammot::evaluator {

/// Each function returns the HTML of one section, or nothing if its data is missing.

/// Pose errors over time, and drift over ten metres.
std::string error_figures(const ReportSource& source);

/// Time per scan of each stage.
std::string latency_figure(const ReportSource& source);

/// Numbers of true objects, tracked objects and false tracks over time; recall by class and
/// distance; labels of echoes.
std::string detection_figures(const ReportSource& source);

/// Path, speed and mode probabilities of single tracks.
std::string track_figures(const ReportSource& source);

/// CSS colour of a class of objects.
const char* colour_of(const std::string& object_class);

/// Pose of the trajectory at the nearest stamp; identity for an empty trajectory.
geometry::Pose2 pose_near(const metrics::Trajectory& trajectory, std::int64_t stamp_ns);

}  // namespace slammot::evaluator
