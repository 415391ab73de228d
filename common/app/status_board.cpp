#include "common/app/status_board.hpp"

namespace slammot::app {

void StatusBoard::set_counters(const std::map<std::string, std::uint64_t>& totals) {
  for (const auto& [name, total] : totals) counters_[name] = total;
}

InputWatch& StatusBoard::input(const std::string& topic_name, Input kind, SteadyTime now) {
  return inputs_.emplace_back(topic_name, kind, now);
}

std::vector<const InputWatch*> StatusBoard::missing_inputs(SteadyTime now) const {
  std::vector<const InputWatch*> missing;
  for (const InputWatch& input : inputs_) {
    if (input.is_missing(now, kPatience)) missing.push_back(&input);
  }
  return missing;
}

std::string StatusBoard::explanation(SteadyTime now) const {
  std::string text;
  const auto add = [&](const std::string& words) { text += text.empty() ? words : ", " + words; };
  for (const auto& [what, words] : troubles_) add(words);
  for (const InputWatch* input : missing_inputs(now)) add(input->complaint(now));
  return text;
}

}  // namespace slammot::app
