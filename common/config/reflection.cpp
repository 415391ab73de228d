#include "common/config/reflection.hpp"

#include <type_traits>

namespace slammot::config {
namespace {

namespace pb = google::protobuf;
using pb::FieldDescriptor;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

}  // namespace

const FieldDescriptor* stage_in_proto(std::string_view stage) {
  const FieldDescriptor* field = Profile::descriptor()->FindFieldByName(std::string(stage));
  const bool is_stage = field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  return is_stage ? field : nullptr;
}

FieldDescriptor::CppType cpp_type_of(const Value& value) {
  return std::visit(Overloaded{[](const bool*) { return FieldDescriptor::CPPTYPE_BOOL; },
                               [](const int*) { return FieldDescriptor::CPPTYPE_INT32; },
                               [](const std::uint32_t*) { return FieldDescriptor::CPPTYPE_UINT32; },
                               [](const std::int64_t*) { return FieldDescriptor::CPPTYPE_INT64; },
                               [](const std::uint64_t*) { return FieldDescriptor::CPPTYPE_UINT64; },
                               [](const float*) { return FieldDescriptor::CPPTYPE_FLOAT; },
                               [](const double*) { return FieldDescriptor::CPPTYPE_DOUBLE; },
                               [](const std::string*) { return FieldDescriptor::CPPTYPE_STRING; }},
                    value);
}

void copy_from_message(const pb::Message& message, const FieldDescriptor& field, const Value& value) {
  const pb::Reflection& from = *message.GetReflection();
  std::visit(Overloaded{[&](bool* to) { *to = from.GetBool(message, &field); },
                        [&](int* to) { *to = from.GetInt32(message, &field); },
                        [&](std::uint32_t* to) { *to = from.GetUInt32(message, &field); },
                        [&](std::int64_t* to) { *to = from.GetInt64(message, &field); },
                        [&](std::uint64_t* to) { *to = from.GetUInt64(message, &field); },
                        [&](float* to) { *to = from.GetFloat(message, &field); },
                        [&](double* to) { *to = from.GetDouble(message, &field); },
                        [&](std::string* to) { *to = from.GetString(message, &field); }},
             value);
}

void copy_to_message(const Value& value, pb::Message& message, const FieldDescriptor& field) {
  const pb::Reflection& to = *message.GetReflection();
  std::visit(Overloaded{[&](const bool* from) { to.SetBool(&message, &field, *from); },
                        [&](const int* from) { to.SetInt32(&message, &field, *from); },
                        [&](const std::uint32_t* from) { to.SetUInt32(&message, &field, *from); },
                        [&](const std::int64_t* from) { to.SetInt64(&message, &field, *from); },
                        [&](const std::uint64_t* from) { to.SetUInt64(&message, &field, *from); },
                        [&](const float* from) { to.SetFloat(&message, &field, *from); },
                        [&](const double* from) { to.SetDouble(&message, &field, *from); },
                        [&](const std::string* from) { to.SetString(&message, &field, *from); }},
             value);
}

}  // namespace slammot::config
