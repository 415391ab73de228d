#pragma once

// Private to common/config: the only header that knows both protobuf and the field tables.

#include <string_view>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "common/config/fields.hpp"
#include "slammot.pb.h"

namespace slammot::config {

/// Profile's field for a stage; nullptr when there is none.
const google::protobuf::FieldDescriptor* stage_in_proto(std::string_view stage);

google::protobuf::FieldDescriptor::CppType cpp_type_of(const Value& value);

/// Precondition: the field is of the value's type (the agreement test sees to it).
void copy_from_message(const google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field, const Value& value);
void copy_to_message(const Value& value, google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field);

}  // namespace slammot::config
