#pragma once

#include <span>
#include <string>

#include "common/config/fields.hpp"

namespace slammot::config {

/// Every setting as it is now, in the text format that overlay_text() reads, each with its meaning as a comment.
/// Read back it gives exactly the same values. Precondition: tables and slammot.proto agree.
std::string print(std::span<const BoundStage> stages);

/// The value as the text format writes it: shortest digits that read back the same, strings quoted. "" for a list.
std::string print_value(const BoundStage& stage, const BoundField& field);

}  // namespace slammot::config
