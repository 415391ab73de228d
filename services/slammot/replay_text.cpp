#include "services/slammot/replay_text.hpp"

#include "common/files/text.hpp"

namespace slammot {
namespace {

using files::text;

unsigned long long number(std::uint64_t value) { return value; }

std::string describe(const std::string& name, const TopicDifferences& topic) {
  std::string lines = text("%s: %llu samples compared, %llu differ", name.c_str(),
                           number(topic.compared), number(topic.different));
  if (topic.missing > 0) lines += text(", %llu are missing", number(topic.missing));
  if (topic.additional > 0) lines += text(", %llu are additional", number(topic.additional));
  lines += "\n";
  for (const auto& [path, field] : topic.fields)
    lines += text("  %s: %llu values differ, by at most %.3g\n", path.c_str(), number(field.values),
                  field.largest);
  return lines;
}

std::string describe(const ReplayDifference& first) {
  std::string line = "first difference: " + first.topic;
  if (first.stamp_ns) line += ", stamp " + std::to_string(*first.stamp_ns) + " ns";
  line += text(", %.3f s into the recording", first.recorded_at_s);
  if (!first.field.empty()) line += ", " + first.field;
  return line + ": " + first.recorded + " was recorded, " + first.replayed + " now\n";
}

}  // namespace

std::string describe(const ReplayComparison& comparison) {
  std::string lines;
  for (const auto& [name, topic] : comparison.topics()) lines += describe(name, topic);
  return lines + (comparison.first() ? describe(*comparison.first()) : "no difference\n");
}

}  // namespace slammot
