#include "common/wire/graph.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

static_assert(static_cast<int>(flow::ConstraintKind::kOdometric) ==
              slammot_CONSTRAINT_KIND_ODOMETRIC);
static_assert(static_cast<int>(flow::ConstraintKind::kLoop) == slammot_CONSTRAINT_KIND_LOOP);
static_assert(static_cast<int>(flow::ClosureState::kAccepted) == slammot_CLOSURE_STATE_ACCEPTED);
static_assert(static_cast<int>(flow::ClosureState::kRejected) == slammot_CLOSURE_STATE_REJECTED);
static_assert(static_cast<int>(flow::ClosureState::kWithdrawn) == slammot_CLOSURE_STATE_WITHDRAWN);

slammot_Georeference encoded(const flow::Georeference& georeference) {
  slammot_Georeference sample{};
  sample.has_position = georeference.has_position;
  sample.has_direction = georeference.has_direction;
  sample.latitude_deg = georeference.origin.latitude_deg;
  sample.longitude_deg = georeference.origin.longitude_deg;
  sample.x_from_east_rad = georeference.x_from_east_rad;
  sample.position_sigma_m = georeference.position_sigma_m;
  sample.direction_sigma_rad = georeference.direction_sigma_rad;
  sample.compass_bias_rad = georeference.compass_bias_rad;
  sample.fix_sigma_m = georeference.fix_sigma_m;
  sample.corrects_map = georeference.corrects_map;
  sample.fix_count = georeference.fixes;
  sample.rejected_fix_count = georeference.rejected_fixes;
  sample.heading_count = georeference.headings;
  sample.rejected_heading_count = georeference.rejected_headings;
  return sample;
}

flow::Georeference decoded(const slammot_Georeference& sample) {
  return {.has_position = sample.has_position,
          .has_direction = sample.has_direction,
          .origin = {sample.latitude_deg, sample.longitude_deg},
          .x_from_east_rad = sample.x_from_east_rad,
          .position_sigma_m = sample.position_sigma_m,
          .direction_sigma_rad = sample.direction_sigma_rad,
          .compass_bias_rad = sample.compass_bias_rad,
          .fix_sigma_m = sample.fix_sigma_m,
          .corrects_map = sample.corrects_map,
          .fixes = sample.fix_count,
          .rejected_fixes = sample.rejected_fix_count,
          .headings = sample.heading_count,
          .rejected_headings = sample.rejected_heading_count};
}

bool is_sound_reference(const slammot_Georeference& sample) {
  return std::abs(sample.latitude_deg) <= 90.0 && std::abs(sample.longitude_deg) <= 360.0 &&
         is_sound(sample.x_from_east_rad) && is_amount(sample.position_sigma_m) &&
         is_amount(sample.direction_sigma_rad) && is_sound(sample.compass_bias_rad) &&
         is_amount(sample.fix_sigma_m);
}

std::string_view fault_of(const slammot_GraphCorrection& part) {
  if (part.part_count == 0 || part.part_count > kMostParts)
    return "part_count is not within 1 and 64";
  if (part.part_index >= part.part_count) return "part_index is not below part_count";
  if (!is_sound(part.map_from_odom)) return "map_from_odom is not finite";
  for (const slammot_CorrectedSubmap& submap : elements(part.submaps)) {
    if (!is_sound(submap.map_from_submap)) return "map_from_submap is not finite";
  }
  for (const slammot_Georeference& georeference : elements(part.georeference)) {
    if (!is_sound_reference(georeference)) return "georeference is not finite";
  }
  return "";
}

std::vector<flow::CorrectedSubmap> decoded_submaps(const slammot_GraphCorrection& part) {
  std::vector<flow::CorrectedSubmap> submaps;
  submaps.reserve(part.submaps._length);
  for (const slammot_CorrectedSubmap& submap : elements(part.submaps))
    submaps.push_back({{submap.submap_id}, decode(submap.map_from_submap)});
  return submaps;
}

bool is_ascending(const std::vector<flow::CorrectedSubmap>& submaps) {
  const auto is_not_below = [](const flow::CorrectedSubmap& a, const flow::CorrectedSubmap& b) {
    return a.submap_id >= b.submap_id;
  };
  return std::adjacent_find(submaps.begin(), submaps.end(), is_not_below) == submaps.end();
}

}  // namespace

slammot_Constraint encode(std::string_view vehicle_id, const flow::Constraint& constraint) {
  slammot_Constraint sample{};
  set_text(sample.vehicle_id, vehicle_id);
  sample.map_id = constraint.map_id.value;
  sample.from_submap_id = constraint.from.value;
  sample.to_submap_id = constraint.to.value;
  sample.kind = static_cast<slammot_ConstraintKind>(constraint.kind);
  sample.from_from_to = encode(constraint.from_to);
  sample.state = static_cast<slammot_ClosureState>(constraint.verdict.state);
  sample.squared_error = constraint.verdict.squared_error;
  sample.agreed_share = constraint.verdict.agreed_share;
  set_text(sample.reason, constraint.verdict.reason);
  return sample;
}

Decoded<flow::Constraint> decode(const slammot_Constraint& sample) {
  if (!is_enumerator(sample.kind, slammot_CONSTRAINT_KIND_LOOP)) return Fault{"kind is unknown"};
  if (sample.from_submap_id == sample.to_submap_id)
    return Fault{"a submap is constrained to itself"};
  if (!is_sound(sample.from_from_to)) return Fault{"from_from_to or its covariance is unsound"};
  if (!is_enumerator(sample.state, slammot_CLOSURE_STATE_WITHDRAWN))
    return Fault{"state is unknown"};
  if (!std::isfinite(sample.squared_error) || !std::isfinite(sample.agreed_share))
    return Fault{"squared_error or agreed_share is not finite"};
  return flow::Constraint{
      .from = {sample.from_submap_id},
      .to = {sample.to_submap_id},
      .kind = static_cast<flow::ConstraintKind>(sample.kind),
      .from_to = decode(sample.from_from_to),
      .map_id = {sample.map_id},
      .verdict = {static_cast<flow::ClosureState>(sample.state), sample.squared_error,
                  sample.agreed_share, std::string(text(sample.reason))}};
}

void GraphCorrectionEncoder::encode(
    std::string_view vehicle_id, const flow::GraphCorrection& correction,
    const std::function<void(const slammot_GraphCorrection&)>& write) {
  const std::size_t submaps = correction.submaps.size();
  const std::size_t parts =
      std::max<std::size_t>(1, (submaps + kMostSubmapsOfPart - 1) / kMostSubmapsOfPart);
  if (parts > kMostParts)
    throw std::length_error("a graph correction has more submaps than fit on the bus");
  set_text(sample_.vehicle_id, vehicle_id);
  sample_.sequence_number = correction.sequence;
  sample_.part_count = static_cast<std::uint32_t>(parts);
  sample_.map_id = correction.map_id.value;
  sample_.map_from_odom = wire::encode(correction.map_from_odom);
  sample_.is_untied = correction.is_untied;
  georeferences_.clear();
  if (correction.georeference) georeferences_.push_back(encoded(*correction.georeference));
  show(sample_.georeference, georeferences_);
  for (std::size_t part = 0; part < parts; ++part) {
    submaps_.clear();
    const std::size_t end = std::min(submaps, (part + 1) * kMostSubmapsOfPart);
    for (std::size_t i = part * kMostSubmapsOfPart; i < end; ++i) {
      submaps_.push_back({correction.submaps[i].submap_id.value,
                          wire::encode(correction.submaps[i].map_from_submap)});
    }
    sample_.part_index = static_cast<std::uint32_t>(part);
    show(sample_.submaps, submaps_);
    write(sample_);
  }
}

GraphCorrectionAssembler::Added GraphCorrectionAssembler::add(const slammot_GraphCorrection& part) {
  if (const std::string_view fault = fault_of(part); !fault.empty()) return {std::nullopt, fault};
  auto complete = parts_.add(part.sequence_number, part.part_index, part.part_count,
                             {{part.map_id}, decode(part.map_from_odom), part.is_untied},
                             decoded_submaps(part));
  if (!complete) return {};
  if (!is_ascending(complete->items)) return {std::nullopt, "submaps are not in ascending order"};
  const auto& [map_id, map_from_odom, is_untied] = complete->shared;
  flow::GraphCorrection correction{
      part.sequence_number, map_from_odom, std::move(complete->items), map_id, is_untied, {}};
  for (const slammot_Georeference& georeference : elements(part.georeference))
    correction.georeference = decoded(georeference);
  return {std::move(correction), ""};
}

}  // namespace slammot::wire
