#include "common/config/print.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <vector>

#include <google/protobuf/text_format.h>

#include "common/config/reflection.hpp"

namespace slammot::config {
namespace {

namespace pb = google::protobuf;

std::string indent(std::size_t depth) { return std::string(2 * depth, ' '); }

/// Braces from one field's place in the nesting to the next one's.
std::string move_between(const std::vector<std::string>& from, const std::vector<std::string>& to) {
  const auto apart = static_cast<std::size_t>(std::ranges::mismatch(from, to).in1 - from.begin());
  std::string text;
  for (std::size_t depth = from.size(); depth > apart; --depth) text += indent(depth - 1) + "}\n";
  for (std::size_t depth = apart; depth < to.size(); ++depth)
    text += indent(depth) + to[depth] + " {\n";
  return text;
}

std::string print_stage(const BoundStage& stage) {
  const pb::FieldDescriptor* stage_field = stage_in_proto(stage.stage);
  assert(stage_field != nullptr);
  std::string text;
  std::vector<std::string> place;
  for (const BoundField& field : stage.fields) {
    const pb::FieldDescriptor* descriptor = find_field(*stage_field->message_type(), field.name);
    assert(descriptor != nullptr);
    std::vector<std::string> next_place = path_of(field.name);
    next_place.pop_back();
    next_place.insert(next_place.begin(), std::string(stage.stage));
    text += move_between(place, next_place);
    text += indent(next_place.size()) + descriptor->name() + ": " + print_value(stage, field) +
            "  # " + std::string(field.meaning) + "\n";
    place = std::move(next_place);
  }
  return text + move_between(place, {});
}

}  // namespace

std::string print_value(const BoundStage& stage, const BoundField& field) {
  const pb::FieldDescriptor* descriptor =
      find_field(*stage_in_proto(stage.stage)->message_type(), field.name);
  assert(descriptor != nullptr);
  if (descriptor->is_repeated()) return "";
  const std::unique_ptr<pb::Message> message(
      pb::MessageFactory::generated_factory()->GetPrototype(descriptor->containing_type())->New());
  copy_to_message(field.value, *message, *descriptor);
  std::string value;
  pb::TextFormat::PrintFieldValueToString(*message, descriptor, -1, &value);
  return value;
}

std::string print(std::span<const BoundStage> stages) {
  std::string text;
  for (const BoundStage& stage : stages) text += print_stage(stage);
  return text;
}

}  // namespace slammot::config
