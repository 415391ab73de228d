#include "examples/joint_posterior/report.hpp"

#include <array>
#include <cstdio>
#include <string_view>

#include "examples/joint_posterior/study.hpp"

namespace slammot::joint_posterior {
namespace {

constexpr std::array<Crowd, 5> kCrowds{{{12, 1}, {12, 4}, {12, 16}, {3, 4}, {3, 16}}};
constexpr std::string_view kBegin = "<!-- joint_posterior: begin -->\n";
constexpr std::string_view kEnd = "<!-- joint_posterior: end -->\n";

std::string row(const Crowd& crowd, Method method, int seeds) {
  const Score score = score_of(method, crowd, seeds);
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "| %zu | %zu | %s | %.3f | %.2f | %.2f | %.3f | %.2f | %.2f | %.0f | %.0f |\n",
                crowd.landmarks, crowd.movers, std::string(name_of(method)).c_str(),
                score.pose_rmse_m, 1e3 * score.heading_rmse_rad, score.pose_nees,
                score.mover_rmse_m, score.velocity_rmse_mps, score.mover_nees, score.numbers,
                score.step_us);
  return text.data();
}

}  // namespace

std::string table(int seeds) {
  std::string text =
      "| landmarks | movers | method | pose RMSE (m) | heading (mrad) | pose NEES | mover RMSE (m) "
      "| velocity (m/s) | mover NEES | covariance numbers | step (us) |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Crowd& crowd : kCrowds) {
    for (const Method method : kMethods) text += row(crowd, method, seeds);
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
