#pragma once

#include <span>
#include <string>

#include "common/config/fields.hpp"

namespace slammot::config {

/// Every current setting in the text format of overlay_text(), with its meaning as a comment.
/// Reading it back gives exactly the same values. Precondition: tables and slammot.proto agree.
std::string print(std::span<const BoundStage> stages);

/// The value as the text format writes it: shortest digits that read back the same, strings quoted.
/// "" for a list.
std::string print_value(const BoundStage& stage, const BoundField& field);

}  // namespace slammot::config
