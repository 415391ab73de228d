#include "common/config/print.hpp"

#include <cassert>
#include <memory>

#include <google/protobuf/text_format.h>

#include "common/config/reflection.hpp"

namespace slammot::config {
namespace {

namespace pb = google::protobuf;

std::string print_stage(const BoundStage& stage) {
  const pb::FieldDescriptor* stage_field = stage_in_proto(stage.stage);
  assert(stage_field != nullptr);
  Profile profile;
  pb::Message& message = *profile.GetReflection()->MutableMessage(&profile, stage_field);
  std::string text = std::string(stage.stage) + " {\n";
  for (const BoundField& field : stage.fields) {
    const pb::FieldDescriptor* descriptor = message.GetDescriptor()->FindFieldByName(std::string(field.name));
    assert(descriptor != nullptr);
    copy_to_message(field.value, message, *descriptor);
    std::string value;
    pb::TextFormat::PrintFieldValueToString(message, descriptor, -1, &value);
    text += "  " + std::string(field.name) + ": " + value + "  # " + std::string(field.meaning) + "\n";
  }
  return text + "}\n";
}

}  // namespace

std::string print(std::span<const BoundStage> stages) {
  std::string text;
  for (const BoundStage& stage : stages) text += print_stage(stage);
  return text;
}

}  // namespace slammot::config
