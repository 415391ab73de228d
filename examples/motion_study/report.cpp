#include "examples/motion_study/report.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "examples/motion_study/scores.hpp"

namespace slammot::motion_study {
namespace {

using simulation::Maneuver;

constexpr double kSettledS = 1.0;  ///< The first second is that of the start (on Figure 4.4).

std::string text_of(double value, int decimals) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return {text.data(), end};
}

/// Part of a maneuver with a table of its own.
struct Part {
  std::string title;
  Maneuver maneuver;
  Span span;
  bool has_changes = true;  ///< Mode delays are those of the whole maneuver.
};

std::vector<Part> parts() {
  std::vector<Part> all;
  for (const Maneuver& maneuver : simulation::thesis_maneuvers())
    all.push_back({std::string(maneuver.name), maneuver, {kSettledS, maneuver.duration_s}, true});
  // Rests half the memory of the series and a second longer.
  const Span rest{simulation::kStandsAtS + 2.0, simulation::kStartsAtS};
  all.push_back({"move-stop-move, at rest", all.back().maneuver, rest, false});
  return all;
}

/// Fields with a separator before each but the first.
std::string joined(const std::vector<std::string>& fields, std::string_view separator) {
  std::string text;
  for (const std::string& field : fields) {
    if (!text.empty()) text.append(separator);
    text.append(field);
  }
  return text;
}

std::string row(Method method, const Part& part, int seeds) {
  const Score score = score_of(method, part.maneuver, part.span, seeds);
  const std::optional<double> delay_s =
      part.has_changes ? mode_delay_s(method, part.maneuver, seeds) : std::nullopt;
  return joined({std::string(name_of(method)), text_of(score.position_rmse_m, 3),
                 text_of(score.velocity_rmse_mps, 2), text_of(score.position_nees, 1),
                 text_of(score.velocity_nees, 1), delay_s ? text_of(*delay_s, 2) : std::string("-"),
                 std::to_string(filters_of(method))},
                " | ");
}

std::string table(const Part& part, int seeds) {
  std::string text("\n");
  text.append(part.title)
      .append("\n\n| method | position RMSE (m) | velocity RMSE (m/s) | position NEES | ")
      .append("velocity NEES | mode delay (s) | filters |\n|---|---|---|---|---|---|---|\n");
  for (const Method method : kMethods)
    text.append("| ").append(row(method, part, seeds)).append(" |\n");
  return text;
}

std::string line(const Maneuver& maneuver, Method method, const Sample& sample) {
  const filters::MotionState& state = sample.estimate.state;
  std::vector<std::string> fields = {std::string(maneuver.name), std::string(name_of(method))};
  for (const double value :
       {sample.time_s, sample.truth[0], sample.truth[1], sample.truth[2], sample.truth[3],
        sample.measured_m.x(), sample.measured_m.y(), state.mean[0], state.mean[1], state.mean[2],
        state.mean[3], std::sqrt(state.covariance(0, 0)), std::sqrt(state.covariance(1, 1)),
        sample.estimate.maneuver_probability})
    fields.push_back(text_of(value, 4));
  fields.emplace_back(sample.estimate.stands ? "1" : "0");
  return joined(fields, ";");
}

}  // namespace

std::string tables(int seeds) {
  std::string text;
  for (const Part& part : parts()) text += table(part, seeds);
  return text;
}

std::string traces(std::uint64_t seed) {
  std::string text =
      "maneuver;method;time_s;x_m;y_m;vx_mps;vy_mps;measured_x_m;measured_y_m;estimated_x_m;"
      "estimated_y_m;estimated_vx_mps;estimated_vy_mps;sigma_x_m;sigma_y_m;maneuver_probability;"
      "stands\n";
  for (const Maneuver& maneuver : simulation::thesis_maneuvers()) {
    for (const Method method : kMethods) {
      for (const Sample& sample : run(method, maneuver, seed))
        text.append(line(maneuver, method, sample)).append("\n");
    }
  }
  return text;
}

}  // namespace slammot::motion_study
