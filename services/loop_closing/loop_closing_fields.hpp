#pragma once

#include "common/config/fields.hpp"
#include "services/loop_closing/loop_closer.hpp"

namespace slammot::loop_closing {

/// The settings of loop closing as message LoopClosing has them.
const config::FieldTable<LoopClosingConfig>& loop_closing_fields();

}  // namespace slammot::loop_closing
