#pragma once

#include <cstdint>

#include "common/app/latency_histogram.hpp"

namespace slammot::app {

/// Adds the time since a scan was published, by the system clocks of both computers [ns since
/// 1970]. Adds nothing where it is unknown (0), negative or longer than 10 s: the clocks are apart,
/// or the scan is of a recording that is played.
void add_since_scan(LatencyHistogram& histogram, std::int64_t scan_published_ns,
                    std::int64_t now_ns);

}  // namespace slammot::app
