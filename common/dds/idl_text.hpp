#pragma once

#include <string>

#include "common/dds/type_model.hpp"

namespace slammot::dds {

/// The types as OMG IDL 4.2 that a compiler of IDL reads back as the same types; comments of the
/// original are not on the bus. Of members that the model does not describe a comment is left.
std::string idl_text(const TypeModel& model);

}  // namespace slammot::dds
