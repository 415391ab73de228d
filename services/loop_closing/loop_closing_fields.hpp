#pragma once

#include "common/config/fields.hpp"
#include "services/loop_closing/loop_closer.hpp"

namespace slammot::loop_closing {

/// Settings of loop closing, as in message LoopClosing.
const config::FieldTable<LoopClosingConfig>& loop_closing_fields();

}  // namespace slammot::loop_closing
