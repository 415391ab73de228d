#pragma once

#include "services/evaluator/result_files.hpp"
#include "services/evaluator/truth_files.hpp"

namespace slammot::evaluator {

/// Truth for drives with annotations in the laser's frame only: covers the scans from the first to
/// the last annotation; the world is the map as published live. An annotation belongs to the latest
/// scan at its time. Between two annotations at most one second apart a person is on the straight
/// line between them and has `points` points; otherwise it may be present but is not required to be
/// seen.
Truth place_annotations(const Truth& truth, const RunResult& result, int points);

}  // namespace slammot::evaluator
