#include "services/evaluator/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/files/text.hpp"
#include "common/geometry/order_statistics.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

constexpr double kLeastSigmaM = 0.1;
constexpr double kTimesMedian = 4.0;
constexpr std::int64_t kGapNs = 1'000'000'000;  // Shorter gaps are bridged.

double sigma_m(const metrics::UncertainStampedPose& pose) {
  const geometry::Matrix3& P = pose.odom_from_base.covariance;
  return std::sqrt(std::max({0.0, P(0, 0), P(1, 1)}));
}

void add_unsure(const RunResult& result, std::vector<Doubt>& doubts) {
  std::vector<double> sigmas_m;
  for (const auto& pose : result.uncertain) sigmas_m.push_back(sigma_m(pose));
  if (sigmas_m.empty()) return;
  const double limit_m = std::max(kLeastSigmaM, kTimesMedian * geometry::upper_median(sigmas_m));
  double most_m = 0.0;
  bool is_open = false;
  for (std::size_t i = 0; i < sigmas_m.size(); ++i) {
    if (!(sigmas_m[i] > limit_m)) continue;
    const std::int64_t stamp_ns = result.uncertain[i].stamp_ns;
    if (!is_open || stamp_ns - doubts.back().end_ns > kGapNs) {
      doubts.push_back({stamp_ns, stamp_ns, {}});
      most_m = 0.0;
      is_open = true;
    }
    most_m = std::max(most_m, sigmas_m[i]);
    doubts.back().end_ns = stamp_ns;
    doubts.back().what =
        files::text("unsure: standard deviation of the position up to %.2f m", most_m);
  }
}

void add_gaps(const RunResult& result, std::vector<Doubt>& doubts) {
  for (std::size_t i = 1; i < result.uncertain.size(); ++i) {
    const std::int64_t from_ns = result.uncertain[i - 1].stamp_ns;
    const std::int64_t to_ns = result.uncertain[i].stamp_ns;
    if (to_ns - from_ns > kGapNs) doubts.push_back({from_ns, to_ns, "no scan was localized"});
  }
}

}  // namespace

std::optional<Doubt> time_before_located(const RunResult& result) {
  const auto report = nlohmann::json::parse(result.report_json, nullptr, false);
  if (!report.is_object() || !report.contains("located_at_s")) return std::nullopt;
  const std::int64_t begin_ns = result.online.front().stamp_ns;
  const auto& at_s = report["located_at_s"];
  Doubt before{begin_ns, result.online.back().stamp_ns,
               "not located in the stored map while driving: online poses are in another frame"};
  if (!at_s.is_number()) return before;
  before.end_ns = begin_ns + to_ns(at_s.get<double>());
  before.what = files::text(
      "located in the stored map after %.1f s: online poses before are in another frame",
      at_s.get<double>());
  return before.end_ns > begin_ns ? std::optional(before) : std::nullopt;
}

std::vector<Doubt> find_doubts(const RunResult& result) {
  std::vector<Doubt> doubts;
  add_unsure(result, doubts);
  add_gaps(result, doubts);
  if (auto before = time_before_located(result)) doubts.push_back(std::move(*before));
  for (const LostSpan& loss : result.losses)
    doubts.push_back({loss.begin_ns, loss.end_ns, "lost: scans do not match the map"});
  std::ranges::stable_sort(doubts, {}, &Doubt::begin_ns);
  return doubts;
}

}  // namespace slammot::evaluator
