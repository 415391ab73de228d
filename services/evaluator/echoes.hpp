#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/trajectory.hpp"

namespace slammot::evaluator {

/// Echoes of one scan in world, deskewed by the vehicle's true motion. One value a beam; empty
/// without echo.
struct EchoesInWorld {
  std::int64_t stamp_ns = 0;
  std::vector<std::optional<geometry::Vector2>> points_m;
};

/// Passes the echoes of every scan to `take`.
using EchoSource = std::function<std::optional<files::Error>(
    const std::function<void(const EchoesInWorld&)>& take)>;

/// Reads a log and passes each scan with a true pose to `take`. `sweep_s`: time from the first beam
/// of a scan to its last.
std::optional<files::Error> read_echoes(const std::filesystem::path& log,
                                        const metrics::Trajectory& truth, double sweep_s,
                                        const std::function<void(const EchoesInWorld&)>& take);

}  // namespace slammot::evaluator
