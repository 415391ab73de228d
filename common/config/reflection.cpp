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
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang before 17 does not deduce it

}  // namespace

const pb::Message* prototype_of(std::string_view message) {
  for (const pb::Message* known :
       {static_cast<const pb::Message*>(&Scenario::default_instance())}) {
    if (known->GetDescriptor()->name() == message) return known;
  }
  return nullptr;
}

const FieldDescriptor* stage_in_proto(std::string_view stage) {
  const FieldDescriptor* field = Profile::descriptor()->FindFieldByName(std::string(stage));
  const bool is_stage = field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  return is_stage ? field : nullptr;
}

std::vector<std::string> path_of(std::string_view dotted_name) {
  std::vector<std::string> path(1);
  for (const char c : dotted_name) {
    if (c == '.') {
      path.emplace_back();
    } else {
      path.back() += c;
    }
  }
  return path;
}

const FieldDescriptor* find_field(const pb::Descriptor& message, std::string_view dotted_name) {
  const pb::Descriptor* level = &message;
  const FieldDescriptor* field = nullptr;
  for (const std::string& name : path_of(dotted_name)) {
    field = level != nullptr ? level->FindFieldByName(name) : nullptr;
    if (field == nullptr) return nullptr;
    level = field->message_type();  // nullptr for what is no message
  }
  return field;
}

std::vector<std::string> leaf_names(const pb::Descriptor& message) {
  std::vector<std::string> names;
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    if (field.message_type() == nullptr || field.is_repeated()) {
      names.push_back(field.name());
    } else {
      for (const std::string& inner : leaf_names(*field.message_type()))
        names.push_back(field.name() + "." + inner);
    }
  }
  return names;
}

FieldDescriptor::CppType cpp_type_of(const Value& value) {
  return std::visit(Overloaded{[](const bool*) { return FieldDescriptor::CPPTYPE_BOOL; },
                               [](const int*) { return FieldDescriptor::CPPTYPE_INT32; },
                               [](const std::uint32_t*) { return FieldDescriptor::CPPTYPE_UINT32; },
                               [](const std::int64_t*) { return FieldDescriptor::CPPTYPE_INT64; },
                               [](const std::uint64_t*) { return FieldDescriptor::CPPTYPE_UINT64; },
                               [](const float*) { return FieldDescriptor::CPPTYPE_FLOAT; },
                               [](const double*) { return FieldDescriptor::CPPTYPE_DOUBLE; },
                               [](const std::string*) { return FieldDescriptor::CPPTYPE_STRING; },
                               [](const Choice&) { return FieldDescriptor::CPPTYPE_ENUM; },
                               [](const List&) { return FieldDescriptor::CPPTYPE_MESSAGE; }},
                    value);
}

void copy_from_message(const pb::Message& message, const FieldDescriptor& field,
                       const Value& value) {
  const pb::Reflection& from = *message.GetReflection();
  std::visit(Overloaded{[&](bool* to) { *to = from.GetBool(message, &field); },
                        [&](int* to) { *to = from.GetInt32(message, &field); },
                        [&](std::uint32_t* to) { *to = from.GetUInt32(message, &field); },
                        [&](std::int64_t* to) { *to = from.GetInt64(message, &field); },
                        [&](std::uint64_t* to) { *to = from.GetUInt64(message, &field); },
                        [&](float* to) { *to = from.GetFloat(message, &field); },
                        [&](double* to) { *to = from.GetDouble(message, &field); },
                        [&](std::string* to) { *to = from.GetString(message, &field); },
                        [&](const Choice& to) { to.set(from.GetEnumValue(message, &field)); },
                        [](const List&) {}},
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
                        [&](const std::string* from) { to.SetString(&message, &field, *from); },
                        [&](const Choice& from) { to.SetEnumValue(&message, &field, from.get()); },
                        [](const List&) {}},
             value);
}

}  // namespace slammot::config
