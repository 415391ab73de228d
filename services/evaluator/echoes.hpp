#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/trajectory.hpp"

namespace slammot::evaluator {

/// The echoes of one scan, brought into the world by the vehicle's true motion; one a beam, none
/// for no echo.
struct EchoesInWorld {
  std::int64_t stamp_ns = 0;
  std::vector<std::optional<geometry::Vector2>> points_m;
};

/// Reads the log of a drive and hands over each scan that has a true pose. sweep_s is the time from
/// the first beam of a scan to its last.
std::optional<files::Error> read_echoes(const std::filesystem::path& log,
                                        const metrics::Trajectory& truth, double sweep_s,
                                        const std::function<void(const EchoesInWorld&)>& take);

}  // namespace slammot::evaluator
