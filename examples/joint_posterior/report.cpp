#include "examples/joint_posterior/report.hpp"

#include <array>
#include <charconv>
#include <string_view>

namespace slammot::joint_posterior {
namespace {

constexpr std::array<Crowd, 5> kCrowds{{{12, 1}, {12, 4}, {12, 16}, {3, 4}, {3, 16}}};
constexpr std::string_view kBegin = "<!-- joint_posterior: begin -->\n";
constexpr std::string_view kEnd = "<!-- joint_posterior: end -->\n";

std::string text_of(double value, int decimals) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return {text.data(), end};
}

std::string row(const Crowd& crowd, Method method, const Score& score) {
  struct Cell {
    double value;
    int decimals;
  };
  const std::array<Cell, 8> cells = {{{score.pose_rmse_m, 3},
                                      {1e3 * score.heading_rmse_rad, 2},
                                      {score.pose_nees, 2},
                                      {score.mover_rmse_m, 3},
                                      {score.velocity_rmse_mps, 2},
                                      {score.mover_nees, 2},
                                      {score.numbers, 0},
                                      {score.step_us, 0}}};
  std::string text = "| " + std::to_string(crowd.landmarks);
  text.append(" | ").append(std::to_string(crowd.movers));
  text.append(" | ").append(name_of(method));
  for (const Cell& cell : cells) text.append(" | ").append(text_of(cell.value, cell.decimals));
  return text.append(" |\n");
}

}  // namespace

std::string table(int seeds, const Clock& now_s) {
  std::string text =
      "| landmarks | movers | method | pose RMSE (m) | heading (mrad) | pose NEES | mover RMSE (m) "
      "| velocity (m/s) | mover NEES | covariance numbers | step (us) |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Crowd& crowd : kCrowds) {
    for (const Method method : kMethods)
      text += row(crowd, method, score_of(method, crowd, seeds, now_s));
  }
  return text;
}

std::string with_table(const std::string& page, const std::string& table) {
  const std::size_t begin = page.find(kBegin);
  const std::size_t end = page.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
  return page.substr(0, begin) + std::string(kBegin) + table + page.substr(end);
}

}  // namespace slammot::joint_posterior
