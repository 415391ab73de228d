#pragma once

#include <cstddef>
#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// Length of a run of neighbouring beams without echo from which on the run shows free space: a
/// shorter one occurs by drop-outs with a chance of more than 1 %. The share of drop-outs is that
/// of beams without echo between two that end on one surface. 1 for a scan with few drop-outs: they
/// do no harm.
std::size_t shortest_free_run(const LaserScan& scan);

/// Sets, one a beam, whether it has no echo and belongs to a run that is too short to show free
/// space. Keeps the memory.
void mark_drop_outs(const LaserScan& scan, std::vector<bool>& may_be_drop_out);

}  // namespace slammot::sensing
