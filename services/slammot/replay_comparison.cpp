#include "services/slammot/replay_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace slammot {
namespace {

constexpr const char* kPublished = "published";
constexpr const char* kNotPublished = "not published";

bool is_real(const dds::CdrValue& value) {
  return value.kind == dds::TypeKind::kFloat32 || value.kind == dds::TypeKind::kFloat64;
}

std::vector<dds::CdrValue> values_of(const dds::TypeModel& model,
                                     std::span<const std::uint8_t> cdr) {
  std::vector<dds::CdrValue> values;
  dds::for_each_value(model, cdr, [&](const dds::CdrValue& value) { values.push_back(value); });
  return values;
}

}  // namespace

double ReplayTolerances::of(const std::string& field) const {
  const std::string path = without_indices(field);
  for (const auto& [name, tolerance] : of_field) {
    if (path == name || path.ends_with("." + name)) return tolerance;
  }
  return general;
}

std::string without_indices(const std::string& path) {
  std::string text;
  bool is_index = false;
  for (const char c : path) {
    if (c == ']') is_index = false;
    if (!is_index) text += c;
    if (c == '[') is_index = true;
  }
  return text;
}

/// Samples of the same bytes are equal. Values of lists that differ in length are compared as far
/// as both have them; the length is a value of its own.
void ReplayComparison::compare(const ReplayedSample& recorded,
                               std::span<const std::uint8_t> replayed) {
  TopicDifferences& topic = topics_[*recorded.topic];
  ++topic.compared;
  if (std::ranges::equal(recorded.cdr, replayed)) return;
  std::unordered_map<std::string, dds::CdrValue> present;
  for (dds::CdrValue& value : values_of(*recorded.model, replayed))
    present[value.path] = std::move(value);
  bool is_different = false;
  for (const dds::CdrValue& value : values_of(*recorded.model, recorded.cdr)) {
    const auto now = present.find(value.path);
    if (now == present.end() || !differ(value, now->second)) continue;
    note(recorded, value, now->second);
    is_different = true;
  }
  if (is_different) ++topic.different;
}

bool ReplayComparison::differ(const dds::CdrValue& a, const dds::CdrValue& b) const {
  if (!is_real(a)) return a.integer != b.integer || a.text != b.text;
  if (std::isnan(a.number) || std::isnan(b.number))
    return std::isnan(a.number) != std::isnan(b.number);
  if (a.number == b.number) return false;
  const double scale = std::max({1.0, std::abs(a.number), std::abs(b.number)});
  return !(std::abs(a.number - b.number) <= tolerances_.of(a.path) * scale);
}

void ReplayComparison::note(const ReplayedSample& sample, const dds::CdrValue& recorded,
                            const dds::CdrValue& replayed) {
  FieldDifferences& field = topics_[*sample.topic].fields[without_indices(recorded.path)];
  ++field.values;
  const double distance = std::abs(recorded.number - replayed.number);
  if (distance > field.largest) field.largest = distance;
  note_first(sample, recorded.path, recorded.to_text(), replayed.to_text());
}

void ReplayComparison::note_first(const ReplayedSample& sample, std::string field,
                                  std::string recorded, std::string replayed) {
  if (first_) return;
  first_ = {*sample.topic,    sample.stamp_ns,     sample.recorded_at_s,
            std::move(field), std::move(recorded), std::move(replayed)};
}

void ReplayComparison::note_missing(const ReplayedSample& recorded) {
  ++topics_[*recorded.topic].missing;
  note_first(recorded, "", kPublished, kNotPublished);
}

void ReplayComparison::note_additional(const ReplayedSample& replayed) {
  ++topics_[*replayed.topic].additional;
  note_first(replayed, "", kNotPublished, kPublished);
}

}  // namespace slammot
