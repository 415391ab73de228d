#include "common/config/overlay.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include "common/config/reflection.hpp"

namespace slammot::config {
namespace {

namespace pb = google::protobuf;

/// Keeps the first error only: later ones are mostly consequences of it.
class FirstError : public pb::io::ErrorCollector {
 public:
  void AddError(int line, pb::io::ColumnNumber column, const std::string& message) override {
    if (!fault_) fault_ = Fault{{}, line + 1, column + 1, message};
  }
  std::optional<Fault> fault() const { return fault_; }

 private:
  std::optional<Fault> fault_;
};

/// A field that the text sets, and where it does so.
struct SetField {
  const pb::Message* message;
  const pb::FieldDescriptor* descriptor;
  pb::TextFormat::ParseLocation location;
};

std::optional<SetField> find_set_field(const pb::Message& stage, const pb::TextFormat::ParseInfoTree* locations,
                                       std::string_view dotted_name) {
  SetField at{&stage, nullptr, {}};
  for (const std::string& name : path_of(dotted_name)) {
    if (at.descriptor != nullptr) {
      locations = locations->GetTreeForNested(at.descriptor, -1);
      at.message = &at.message->GetReflection()->GetMessage(*at.message, at.descriptor);
    }
    at.descriptor = at.message->GetDescriptor()->FindFieldByName(name);
    if (at.descriptor == nullptr || !at.message->GetReflection()->HasField(*at.message, at.descriptor)) return std::nullopt;
  }
  at.location = locations->GetLocation(at.descriptor, -1);
  return at;
}

/// Copies what the text sets, field by field.
std::optional<Fault> overlay_stage(const pb::Message& message, const pb::TextFormat::ParseInfoTree* locations,
                                   const BoundStage& stage) {
  for (const BoundField& field : stage.fields) {
    const std::optional<SetField> set = find_set_field(message, locations, field.name);
    if (!set) continue;
    copy_from_message(*set->message, *set->descriptor, field.value);
    if (const auto fault = find_fault(field)) {
      return Fault{{}, set->location.line + 1, set->location.column + 1, std::string(stage.stage) + "." + *fault};
    }
  }
  return std::nullopt;
}

std::optional<Fault> overlay_stages(const Profile& profile, pb::TextFormat::ParseInfoTree& locations,
                                    std::span<const BoundStage> stages) {
  for (const BoundStage& stage : stages) {
    const pb::FieldDescriptor* descriptor = stage_in_proto(stage.stage);
    if (descriptor == nullptr || !profile.GetReflection()->HasField(profile, descriptor)) continue;
    const pb::Message& message = profile.GetReflection()->GetMessage(profile, descriptor);
    if (auto fault = overlay_stage(message, locations.GetTreeForNested(descriptor, -1), stage)) return fault;
  }
  return std::nullopt;
}

std::optional<Fault> in_file(std::optional<Fault> fault, const std::string& file_name) {
  if (fault) fault->file = file_name;
  return fault;
}

}  // namespace

std::string Fault::text() const {
  if (line == 0) return file + ": " + message;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message;
}

std::optional<Fault> overlay_text(std::string_view text, const std::string& file_name, std::span<const BoundStage> stages) {
  Profile profile;
  FirstError errors;
  pb::TextFormat::ParseInfoTree locations;
  pb::TextFormat::Parser parser;
  parser.RecordErrorsTo(&errors);
  parser.WriteLocationsTo(&locations);
  pb::io::ArrayInputStream input(text.data(), static_cast<int>(text.size()));
  if (!parser.Parse(&input, &profile)) {
    return in_file(errors.fault().value_or(Fault{{}, 0, 0, "not a configuration in protobuf text format"}), file_name);
  }
  return in_file(overlay_stages(profile, locations, stages), file_name);
}

std::optional<Fault> overlay_file(const std::filesystem::path& file, std::span<const BoundStage> stages) {
  std::error_code not_there;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, not_there)) return Fault{file.string(), 0, 0, "cannot be read"};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return overlay_text(text, file.string(), stages);
}

std::vector<std::string> differences_from_proto(const BoundStage& stage) {
  const pb::FieldDescriptor* stage_field = stage_in_proto(stage.stage);
  if (stage_field == nullptr) return {std::string(stage.stage) + ": no such message in Profile"};
  std::vector<std::string> differences;
  const std::string prefix = std::string(stage.stage) + ".";
  for (const BoundField& field : stage.fields) {
    const pb::FieldDescriptor* descriptor = find_field(*stage_field->message_type(), field.name);
    if (descriptor == nullptr) {
      differences.push_back(prefix + field.name + ": only in the table");
    } else if (descriptor->cpp_type() != cpp_type_of(field.value) || !descriptor->has_presence()) {
      differences.push_back(prefix + field.name + ": types differ, or not optional");
    }
  }
  for (const std::string& name : leaf_names(*stage_field->message_type())) {
    if (std::ranges::count(stage.fields, name, &BoundField::name) != 1) differences.push_back(prefix + name + ": not once in the table");
  }
  return differences;
}

std::vector<std::string> stages_in_proto() {
  std::vector<std::string> stages;
  const pb::Descriptor& profile = *Profile::descriptor();
  for (int i = 0; i < profile.field_count(); ++i) {
    if (profile.field(i)->cpp_type() == pb::FieldDescriptor::CPPTYPE_MESSAGE) stages.push_back(profile.field(i)->name());
  }
  return stages;
}

}  // namespace slammot::config
