#include "common/config/overlay.hpp"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>
#include <memory>

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include "common/config/nearest.hpp"
#include "common/config/profiles.hpp"
#include "common/config/reflection.hpp"
#include "common/config/replaced_settings.hpp"

namespace slammot::config {
namespace {

namespace pb = google::protobuf;

constexpr int kMostBases = 8;  ///< A profile's base may have a base; more are a circle.

/// The part of a text between two others; nothing where they are not there.
std::optional<std::string> between(const std::string& text, std::string_view before,
                                   std::string_view after) {
  const std::size_t start = text.find(before);
  if (start == std::string::npos) return std::nullopt;
  const std::size_t from = start + before.size();
  const std::size_t end = text.find(after, from);
  return end == std::string::npos ? std::nullopt : std::optional(text.substr(from, end - from));
}

/// "; 'scale' took its place", or nothing where none did.
std::string hint_at_replacement(const pb::Descriptor& message, std::string_view name) {
  const auto* setting = std::ranges::find_if(kReplacedSettings, [&](const ReplacedSetting& one) {
    return one.message == message.name() && one.name == name;
  });
  if (setting == kReplacedSettings.end()) return {};
  return "; '" + std::string(setting->replacement) + "' took its place";
}

/// protobuf's words on a name that a message does not have, in ours and with what replaced it or
/// else the nearest name that it has; other faults as they are.
std::string in_our_words(const std::string& fault) {
  const auto message = between(fault, "Message type \"", "\"");
  const auto name = between(fault, "has no field named \"", "\"");
  const pb::Descriptor* descriptor =
      message && name ? pb::DescriptorPool::generated_pool()->FindMessageTypeByName(*message)
                      : nullptr;
  if (descriptor == nullptr || descriptor->field_count() == 0) return fault;
  const std::string unknown = "no setting is called '" + *name + "' here";
  const std::string replacement = hint_at_replacement(*descriptor, *name);
  if (!replacement.empty()) return unknown + replacement;
  std::vector<std::string> known;
  for (int i = 0; i < descriptor->field_count(); ++i) known.push_back(descriptor->field(i)->name());
  return unknown + hint_at_nearest(*name, known);
}

/// Keeps the first error only: later ones are mostly consequences of it.
class FirstError : public pb::io::ErrorCollector {
 public:
  void AddError(int line, pb::io::ColumnNumber column, const std::string& message) override {
    if (!fault_) fault_ = Fault{{}, line + 1, column + 1, in_our_words(message)};
  }
  std::optional<Fault> fault() const { return fault_; }

 private:
  std::optional<Fault> fault_;
};

/// A field set by the text, with its location.
struct SetField {
  const pb::Message* message;
  const pb::FieldDescriptor* descriptor;
  const pb::TextFormat::ParseInfoTree* siblings;  ///< Locations in the message that contains it.
  pb::TextFormat::ParseLocation location;
};

bool is_set(const pb::Message& message, const pb::FieldDescriptor* field) {
  if (field->is_repeated()) return message.GetReflection()->FieldSize(message, field) > 0;
  return message.GetReflection()->HasField(message, field);
}

std::optional<SetField> find_set_field(const pb::Message& stage,
                                       const pb::TextFormat::ParseInfoTree* locations,
                                       std::string_view dotted_name) {
  SetField at{&stage, nullptr, nullptr, {}};
  for (const std::string& name : path_of(dotted_name)) {
    if (at.descriptor != nullptr) {
      locations = locations->GetTreeForNested(at.descriptor, -1);
      at.message = &at.message->GetReflection()->GetMessage(*at.message, at.descriptor);
    }
    at.descriptor = at.message->GetDescriptor()->FindFieldByName(name);
    if (at.descriptor == nullptr || !is_set(*at.message, at.descriptor)) return std::nullopt;
  }
  at.siblings = locations;
  at.location = locations->GetLocation(at.descriptor, at.descriptor->is_repeated() ? 0 : -1);
  return at;
}

std::optional<Fault> overlay_fields(const pb::Message& message,
                                    const pb::TextFormat::ParseInfoTree* locations,
                                    const std::string& place,
                                    const std::vector<BoundField>& fields);

std::optional<Fault> overlay_list(const SetField& set, const std::string& name, const List& list) {
  list.clear();
  const pb::Reflection& reflection = *set.message->GetReflection();
  for (int i = 0; i < reflection.FieldSize(*set.message, set.descriptor); ++i) {
    const pb::Message& element = reflection.GetRepeatedMessage(*set.message, set.descriptor, i);
    if (auto fault = overlay_fields(element, set.siblings->GetTreeForNested(set.descriptor, i),
                                    name, list.append()))
      return fault;
  }
  return std::nullopt;
}

/// Copies the fields that the text sets.
std::optional<Fault> overlay_fields(const pb::Message& message,
                                    const pb::TextFormat::ParseInfoTree* locations,
                                    const std::string& place,
                                    const std::vector<BoundField>& fields) {
  for (const BoundField& field : fields) {
    const std::optional<SetField> set = find_set_field(message, locations, field.name);
    if (!set) continue;
    if (const List* list = std::get_if<List>(&field.value)) {
      if (auto fault = overlay_list(*set, place + "." + field.name, *list)) return fault;
      continue;
    }
    copy_from_message(*set->message, *set->descriptor, field.value);
    if (const auto fault = find_fault(field)) {
      return Fault{{}, set->location.line + 1, set->location.column + 1, place + "." + *fault};
    }
  }
  return std::nullopt;
}

std::optional<Fault> overlay_stages(const Profile& profile,
                                    pb::TextFormat::ParseInfoTree& locations,
                                    std::span<const BoundStage> stages) {
  for (const BoundStage& stage : stages) {
    const pb::FieldDescriptor* descriptor = stage_in_proto(stage.stage);
    if (descriptor == nullptr || !profile.GetReflection()->HasField(profile, descriptor)) continue;
    const pb::Message& message = profile.GetReflection()->GetMessage(profile, descriptor);
    if (auto fault = overlay_fields(message, locations.GetTreeForNested(descriptor, -1),
                                    std::string(stage.stage), stage.fields))
      return fault;
  }
  return std::nullopt;
}

std::optional<Fault> parse(std::string_view text, pb::Message& message,
                           pb::TextFormat::ParseInfoTree& locations) {
  FirstError errors;
  pb::TextFormat::Parser parser;
  parser.RecordErrorsTo(&errors);
  parser.WriteLocationsTo(&locations);
  pb::io::ArrayInputStream input(text.data(), static_cast<int>(text.size()));
  if (parser.Parse(&input, &message)) return std::nullopt;
  return errors.fault().value_or(Fault{{}, 0, 0, "not a configuration in protobuf text format"});
}

std::optional<std::string> text_of(const std::filesystem::path& file) {
  std::error_code not_there;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, not_there)) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> differences(const pb::Descriptor& message, const std::string& prefix,
                                     const std::vector<BoundField>& fields) {
  std::vector<std::string> found;
  for (const BoundField& field : fields) {
    const pb::FieldDescriptor* descriptor = find_field(message, field.name);
    const List* list = std::get_if<List>(&field.value);
    if (descriptor == nullptr) {
      found.push_back(prefix + field.name + ": only in the table");
    } else if (descriptor->cpp_type() != cpp_type_of(field.value) ||
               (list != nullptr ? !descriptor->is_repeated() : !descriptor->has_presence())) {
      found.push_back(prefix + field.name + ": types differ, or not optional");
    } else if (list != nullptr) {
      const auto inner =
          differences(*descriptor->message_type(), prefix + field.name + ".", list->append());
      found.insert(found.end(), inner.begin(), inner.end());
    }
  }
  for (const std::string& name : leaf_names(message)) {
    if (std::ranges::count(fields, name, &BoundField::name) != 1)
      found.push_back(prefix + name + ": not once in the table");
  }
  return found;
}

std::optional<Fault> in_file(std::optional<Fault> fault, const std::string& file_name) {
  if (fault) fault->file = file_name;
  return fault;
}

std::optional<Fault> overlay_with_bases(std::string_view text, const std::string& file_name,
                                        std::span<const BoundStage> stages, int bases_left);

/// Overlays the profile that another one names as its base.
std::optional<Fault> overlay_base(const std::string& name, std::span<const BoundStage> stages,
                                  int bases_left) {
  if (bases_left == 0) return Fault{{}, 0, 0, "base: profiles that are each other's base"};
  const auto file = find_profile(name);
  const auto text = file ? text_of(*file) : std::nullopt;
  return text ? overlay_with_bases(*text, file->string(), stages, bases_left - 1)
              : Fault{{}, 0, 0, "base: " + unknown_profile(name)};
}

std::optional<Fault> overlay_with_bases(std::string_view text, const std::string& file_name,
                                        std::span<const BoundStage> stages, int bases_left) {
  Profile profile;
  pb::TextFormat::ParseInfoTree locations;
  if (auto fault = parse(text, profile, locations)) return in_file(fault, file_name);
  if (profile.has_base()) {
    auto fault = overlay_base(profile.base(), stages, bases_left);
    if (fault && fault->file.empty()) {
      const auto place = locations.GetLocation(Profile::descriptor()->FindFieldByName("base"), -1);
      return Fault{file_name, place.line + 1, place.column + 1, fault->message};
    }
    if (fault) return fault;
  }
  return in_file(overlay_stages(profile, locations, stages), file_name);
}

}  // namespace

std::string Fault::text() const {
  if (line == 0) return file + ": " + message;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message;
}

std::optional<Fault> overlay_text(std::string_view text, const std::string& file_name,
                                  std::span<const BoundStage> stages) {
  return overlay_with_bases(text, file_name, stages, kMostBases);
}

std::optional<Fault> overlay_message_text(std::string_view text, const std::string& file_name,
                                          const BoundStage& stage) {
  assert(prototype_of(stage.stage) != nullptr);
  const std::unique_ptr<pb::Message> message(prototype_of(stage.stage)->New());
  pb::TextFormat::ParseInfoTree locations;
  if (auto fault = parse(text, *message, locations)) return in_file(fault, file_name);
  return in_file(overlay_fields(*message, &locations, std::string(stage.stage), stage.fields),
                 file_name);
}

std::optional<Fault> overlay_file(const std::filesystem::path& file,
                                  std::span<const BoundStage> stages) {
  const auto text = text_of(file);
  return text ? overlay_text(*text, file.string(), stages)
              : Fault{file.string(), 0, 0, "cannot be read"};
}

std::optional<Fault> overlay_message_file(const std::filesystem::path& file,
                                          const BoundStage& message) {
  const auto text = text_of(file);
  return text ? overlay_message_text(*text, file.string(), message)
              : Fault{file.string(), 0, 0, "cannot be read"};
}

std::vector<std::string> differences_from_proto(const BoundStage& stage) {
  if (const pb::Message* message = prototype_of(stage.stage))
    return differences(*message->GetDescriptor(), std::string(stage.stage) + ".", stage.fields);
  const pb::FieldDescriptor* stage_field = stage_in_proto(stage.stage);
  if (stage_field == nullptr) return {std::string(stage.stage) + ": no such message in Profile"};
  return differences(*stage_field->message_type(), std::string(stage.stage) + ".", stage.fields);
}

std::vector<std::string> stages_in_proto() {
  std::vector<std::string> stages;
  const pb::Descriptor& profile = *Profile::descriptor();
  for (int i = 0; i < profile.field_count(); ++i) {
    if (profile.field(i)->cpp_type() == pb::FieldDescriptor::CPPTYPE_MESSAGE)
      stages.push_back(profile.field(i)->name());
  }
  return stages;
}

}  // namespace slammot::config
