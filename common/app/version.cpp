#include "common/app/version.hpp"

namespace slammot::app {

const std::string_view kVersion = SLAMMOT_VERSION;

}  // namespace slammot::app
