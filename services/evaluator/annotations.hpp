#pragma once

#include "services/evaluator/result_files.hpp"
#include "services/evaluator/truth_files.hpp"

namespace slammot::evaluator {

/// Where the only truth is what was annotated in the frame of the laser: the truth of the scans
/// from the first annotation to the last, in a world that is the map as published live. An
/// annotation is of the latest scan at its time. A person is there at a scan between two
/// annotations at most a second apart, on the straight line between them, with as many points as
/// count; else it may be there, unseen.
Truth place_annotations(const Truth& truth, const RunResult& result, int points);

}  // namespace slammot::evaluator
