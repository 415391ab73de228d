#pragma once

// Private to common/config: the only header that knows both protobuf and the field tables.

#include <string>
#include <string_view>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "common/config/fields.hpp"
#include "scenario.pb.h"
#include "slammot.pb.h"

namespace slammot::config {

/// An empty message of that name that is a file of its own, other than Profile; nullptr when there
/// is none.
const google::protobuf::Message* prototype_of(std::string_view message);

/// Profile's field for a stage; nullptr when there is none.
const google::protobuf::FieldDescriptor* stage_in_proto(std::string_view stage);

/// The names in "outer.inner", outermost first.
std::vector<std::string> path_of(std::string_view dotted_name);

/// The field under a dotted name, or nullptr.
const google::protobuf::FieldDescriptor* find_field(const google::protobuf::Descriptor& message,
                                                    std::string_view dotted_name);

/// All fields that are no single messages, with dotted names, in the order of their declaration.
std::vector<std::string> leaf_names(const google::protobuf::Descriptor& message);

google::protobuf::FieldDescriptor::CppType cpp_type_of(const Value& value);

/// Precondition: the field is of the value's type (the agreement test sees to it). Not for lists.
void copy_from_message(const google::protobuf::Message& message,
                       const google::protobuf::FieldDescriptor& field, const Value& value);
void copy_to_message(const Value& value, google::protobuf::Message& message,
                     const google::protobuf::FieldDescriptor& field);

}  // namespace slammot::config
