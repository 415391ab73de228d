#pragma once

#include "common/config/fields.hpp"
#include "services/localization/localizer.hpp"

namespace slammot::localization {

/// The settings of localization as message Localization has them.
const config::FieldTable<LocalizerConfig>& localization_fields();

}  // namespace slammot::localization
