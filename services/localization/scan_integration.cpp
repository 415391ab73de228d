#include "services/localization/scan_integration.hpp"

#include <algorithm>
#include <utility>

#include "common/sensing/drop_outs.hpp"
#include "services/localization/label_echo.hpp"

namespace slammot::localization {
namespace {

using flow::EndCell;
using flow::PointLabel;
using geometry::Vector2;

/// How long the map waits for labels, by the scans' stamps, before it goes on without.
struct Patience {
  std::size_t scans;
  double time_s;
};
/// Labels came until now: tracking or detection may be being restarted. A car that stops meanwhile
/// does not get into the map for good.
constexpr Patience kPatience{30, 0.6};
constexpr Patience kWithoutTracking{4, 0.15};

/// Without anybody's labels: what the map does not explain stays out of it.
grids::Echo unexplained_out(EndCell end_cell) {
  return end_cell == EndCell::kNoEcho || end_cell == EndCell::kFree ? grids::Echo::kNone
                                                                    : grids::Echo::kStationary;
}

}  // namespace

grids::Ray ScanIntegration::ray_of(const ScanToMap& to_map, std::size_t beam,
                                   const geometry::Matrix2& turn, const Vector2& origin_in_odom_m,
                                   double no_echo_free_m) const {
  const sensing::LaserScan& scan = to_map.scan;
  if (to_map.localized.beams[beam].end_cell != EndCell::kNoEcho) {
    const Vector2 end_m =
        to_map.localized.odom_from_base.pose.translation_m() + turn * to_map.points_in_base_m[beam];
    const bool is_companion = std::ranges::binary_search(to_map.companion_beams, beam);
    const bool is_far = (end_m - origin_in_odom_m).squaredNorm() >
                        config_.echoes.map_range_m * config_.echoes.map_range_m;
    return {end_m, is_far || is_companion ? grids::Echo::kTooFar : grids::Echo::kStationary};
  }
  // Nearer echoes than the least range, and drop-outs, tell nothing, not even that there is free
  // space. Nor does any beam of what is so far away that nothing has answered from there.
  const bool tells_nothing =
      may_be_drop_out_[beam] || sensing::is_echo(scan.range_m[beam], scan.scanner.max_range_m);
  const double free_m = tells_nothing ? 0.0 : no_echo_free_m;
  return {origin_in_odom_m + free_m * to_map.beams_in_odom[beam], grids::Echo::kNone};
}

void ScanIntegration::remember(const ScanToMap& to_map, MapAdmission admission, LocalMap& map) {
  const sensing::LaserScan& scan = to_map.scan;
  const flow::LocalizedScan& localized = to_map.localized;
  PendingScan& pending = pending_.push_back();
  pending.admission = admission;
  pending.fallback.clear();
  pending.stamp_ns = scan.stamp_ns;
  pending.sequence = scan.sequence;
  pending.scanner_id = scan.scanner.scanner_id;
  pending.beam_step_rad = scan.scanner.beam_step_rad;
  pending.origin_in_odom_m =
      (localized.odom_from_base.pose * scan.scanner.base_from_laser).translation_m();
  pending.rays.resize(localized.beams.size());
  pending.end_cells.resize(localized.beams.size());
  echo_reach_.add(scan);
  sensing::mark_drop_outs(scan, may_be_drop_out_);
  const double no_echo_free_m =
      std::min(config_.map.no_echo_free_m, echo_reach_.reach_m(scan.scanner.scanner_id));
  const geometry::Matrix2 turn = geometry::rotation(localized.odom_from_base.pose.heading_rad);
  for (std::size_t i = 0; i < localized.beams.size(); ++i) {
    pending.end_cells[i] = localized.beams[i].end_cell;
    pending.rays[i] = ray_of(to_map, i, turn, pending.origin_in_odom_m, no_echo_free_m);
  }
  if (pending_.size() == 1 && admission != MapAdmission::kWithheld)
    map.prepare(pending.origin_in_odom_m, pending.rays, pending.beam_step_rad);
}

void ScanIntegration::note(const flow::SegmentedScan& segmented) {
  for (PendingScan& scan : pending_.all()) {
    const bool is_it =
        scan.sequence == segmented.sequence && scan.scanner_id == segmented.scanner_id;
    if (is_it && segmented.labels.size() == scan.rays.size()) scan.fallback = segmented.labels;
  }
}

bool ScanIntegration::awaits_last(const sensing::LaserScan& scan) const {
  if (pending_.empty()) return false;
  const PendingScan& pending = pending_.back();
  return pending.sequence == scan.sequence && pending.scanner_id == scan.scanner.scanner_id &&
         pending.stamp_ns == scan.stamp_ns;
}

bool ScanIntegration::is_of(const PendingScan& scan, const flow::ScanLabels& labels) {
  return scan.sequence == labels.sequence && scan.scanner_id == labels.scanner_id &&
         scan.rays.size() == labels.labels.size();
}

bool ScanIntegration::awaits(const flow::ScanLabels& labels) const {
  return std::ranges::any_of(pending_.all(),
                             [&](const PendingScan& scan) { return is_of(scan, labels); });
}

void ScanIntegration::integrate_first(const std::vector<PointLabel>* labels, PoseTrust trust,
                                      LocalMap& map, IntegrationCounts& counts) {
  PendingScan& scan = pending_.front();
  if (scan.admission == MapAdmission::kWithheld) {
    counts.withheld_scans += scan.rays.empty() ? 0 : 1;  // of a blank scan there is nothing
    pending_.pop_front();
    return;
  }
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    if (scan.rays[i].echo != grids::Echo::kStationary || !config_.echoes.leave_out_moving) continue;
    scan.rays[i].echo = labels ? echo_of((*labels)[i]) : unexplained_out(scan.end_cells[i]);
  }
  if (scan.admission == MapAdmission::kDoubted && trust == PoseTrust::kDoubted)
    doubted_.push_back(std::move(scan));
  else integrate(scan, map);
  pending_.pop_front();
}

/// Takes it, and leaves memory in its place.
void ScanIntegration::integrate(PendingScan& scan, LocalMap& map) {
  ++integrated_scans_;
  map.integrate(scan.stamp_ns, scan.origin_in_odom_m, scan.rays, scan.beam_step_rad);
  if (integrated_.size() == kScansKeptForRestoring) integrated_.pop_front();
  std::swap(integrated_.push_back(), scan);
}

void ScanIntegration::integrate_first_without_tracking(PoseTrust trust, LocalMap& map,
                                                       IntegrationCounts& counts) {
  ++counts.fallback_integrations;
  integrate_first(pending_.front().fallback.empty() ? nullptr : &pending_.front().fallback, trust,
                  map, counts);
}

IntegrationCounts ScanIntegration::integrate_overdue(std::int64_t now_ns, PoseTrust trust,
                                                     LocalMap& map) {
  const auto is_overdue = [&] {
    const double waited_s = static_cast<double>(now_ns - pending_.front().stamp_ns) * 1e-9;
    const Patience& patience = labels_come_ ? kPatience : kWithoutTracking;
    return pending_.size() >= patience.scans || waited_s > patience.time_s;
  };
  IntegrationCounts counts;
  while (!pending_.empty() && is_overdue()) {
    labels_come_ = false;
    integrate_first_without_tracking(trust, map, counts);
  }
  return counts;
}

IntegrationCounts ScanIntegration::integrate_all(PoseTrust trust, LocalMap& map) {
  IntegrationCounts counts;
  while (!pending_.empty()) integrate_first_without_tracking(trust, map, counts);
  return counts;
}

IntegrationCounts ScanIntegration::integrate(const flow::ScanLabels& labels, PoseTrust trust,
                                             LocalMap& map) {
  IntegrationCounts counts;
  if (awaits(labels)) {
    while (!is_of(pending_.front(), labels)) integrate_first_without_tracking(trust, map, counts);
    integrate_first(&labels.labels, trust, map, counts);
    labels_come_ = true;
  }
  counts.restored_points = restore_points(labels, map);
  return counts;
}

std::uint64_t ScanIntegration::restore_points(const flow::ScanLabels& labels, LocalMap& map) {
  std::uint64_t count = 0;
  for (const flow::RestoredPoints& restored : labels.restored) {
    auto integrated = integrated_.all();
    const auto is_it = [&](const PendingScan& one) {
      return one.sequence == restored.sequence && one.scanner_id == labels.scanner_id;
    };
    const auto found = std::ranges::find_if(integrated, is_it);
    if (found == integrated.end()) continue;
    PendingScan& scan = *found;
    for (const std::uint16_t beam : restored.beams) {
      if (beam >= scan.rays.size() || scan.end_cells[beam] == EndCell::kNoEcho ||
          scan.rays[beam].echo == grids::Echo::kTooFar)
        continue;
      map.restore_stationary(scan.rays[beam].end_m,
                             std::exchange(scan.rays[beam].echo, grids::Echo::kStationary));
      ++count;
    }
  }
  return count;
}

void ScanIntegration::integrate_doubted(LocalMap& map) {
  for (PendingScan& scan : doubted_) integrate(scan, map);
  doubted_.clear();
}

IntegrationCounts ScanIntegration::drop_doubted() {
  const IntegrationCounts counts{.withheld_scans = doubted_.size()};
  doubted_.clear();
  return counts;
}

}  // namespace slammot::localization
