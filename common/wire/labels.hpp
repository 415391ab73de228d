#pragma once

#include <span>
#include <vector>

#include "common/flow/segmented_scan.hpp"
#include "idl/detection.h"

/// Point labels on the wire; what segmented scans and scan labels share.
namespace slammot::wire {

slammot_PointLabel encode(flow::PointLabel label);
flow::PointLabel decode(slammot_PointLabel label);
bool are_labels(std::span<const slammot_PointLabel> labels);

/// Fills `to`, keeping its memory.
void encode_labels(const std::vector<flow::PointLabel>& from, std::vector<slammot_PointLabel>& to);
std::vector<flow::PointLabel> decode_labels(std::span<const slammot_PointLabel> labels);

}  // namespace slammot::wire
