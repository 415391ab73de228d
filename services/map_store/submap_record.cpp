#include "services/map_store/submap_record.hpp"

#include <algorithm>
#include <cstring>

#include "services/map_store/blob.hpp"
#include "submap_record.pb.h"

namespace slammot::map_store {
namespace {

void set_pose(const geometry::Pose2& pose, PoseRecord& record) {
  record.set_x_m(pose.x_m);
  record.set_y_m(pose.y_m);
  record.set_heading_rad(pose.heading_rad);
}

geometry::Pose2 pose_of(const PoseRecord& record) {
  return {record.x_m(), record.y_m(), record.heading_rad()};
}

constexpr int kNumbersOfFix = 7;
constexpr int kNumbersOfHeading = 3;

void set_measurements(const flow::Submap& submap, SubmapRecord& record) {
  for (const flow::SubmapFix& fix : submap.fixes) {
    for (const double number :
         {double{fix.x_m}, double{fix.y_m}, fix.position.latitude_deg, fix.position.longitude_deg,
          double{fix.east_variance_m2}, double{fix.north_variance_m2}, double{fix.covariance_m2}})
      record.add_fix(number);
  }
  for (const flow::SubmapHeading& heading : submap.headings) {
    for (const float number : {heading.in_submap_rad, heading.from_east_rad, heading.sigma_rad})
      record.add_heading(number);
  }
}

void read_measurements(const SubmapRecord& record, flow::Submap& submap) {
  const auto number = [&](int i) { return static_cast<float>(record.fix(i)); };
  for (int i = 0; i + kNumbersOfFix <= record.fix_size(); i += kNumbersOfFix)
    submap.fixes.push_back({number(i),
                            number(i + 1),
                            {record.fix(i + 2), record.fix(i + 3)},
                            number(i + 4),
                            number(i + 5),
                            number(i + 6)});
  for (int i = 0; i + kNumbersOfHeading <= record.heading_size(); i += kNumbersOfHeading)
    submap.headings.push_back({record.heading(i), record.heading(i + 1), record.heading(i + 2)});
}

SubmapRecord to_record(const flow::Submap& submap) {
  SubmapRecord record;
  record.set_map_id(submap.map_id.value);
  record.set_submap_id(submap.submap_id.value);
  record.set_first_stamp_ns(submap.first_stamp_ns);
  record.set_last_stamp_ns(submap.last_stamp_ns);
  set_pose(submap.odom_from_submap, *record.mutable_odom_from_submap());
  set_pose(submap.previous_from_submap.pose, *record.mutable_previous_from_submap());
  for (int i = 0; i < 9; ++i)
    record.add_previous_from_submap_covariance(
        submap.previous_from_submap.covariance(i / 3, i % 3));
  set_pose(submap.submap_from_base_at_end, *record.mutable_submap_from_base_at_end());
  record.set_travelled_m(submap.travelled_m);
  record.set_cell_size_m(submap.cell_size_m);
  record.set_min_x_m(submap.min_x_m);
  record.set_min_y_m(submap.min_y_m);
  record.set_columns(submap.columns);
  record.set_rows(submap.rows);
  record.set_so_log_odds(submap.so_log_odds.data(), submap.so_log_odds.size());
  record.set_mo_evidence(submap.mo_evidence.data(), submap.mo_evidence.size());
  for (const flow::Surfel& surfel : submap.surfels) {
    record.add_surfel_x_m(surfel.x_m);
    record.add_surfel_y_m(surfel.y_m);
    record.add_surfel_normal_x(surfel.normal_x);
    record.add_surfel_normal_y(surfel.normal_y);
    record.add_surfel_weight(surfel.weight);
  }
  record.set_saliency(submap.saliency);
  set_measurements(submap, record);
  return record;
}

bool is_consistent(const SubmapRecord& record) {
  const std::size_t cells = std::size_t{record.columns()} * record.rows();
  const int surfels = record.surfel_x_m_size();
  return record.so_log_odds().size() == cells && record.mo_evidence().size() == cells &&
         record.previous_from_submap_covariance_size() == 9 &&
         record.fix_size() <= kNumbersOfFix * static_cast<int>(flow::kMostFixesOfSubmap) &&
         record.heading_size() <=
             kNumbersOfHeading * static_cast<int>(flow::kMostHeadingsOfSubmap) &&
         record.surfel_y_m_size() == surfels && record.surfel_normal_x_size() == surfels &&
         record.surfel_normal_y_size() == surfels && record.surfel_weight_size() == surfels;
}

flow::Submap from_record(const SubmapRecord& record) {
  flow::Submap submap;
  submap.map_id.value = record.map_id();
  submap.submap_id.value = record.submap_id();
  submap.first_stamp_ns = record.first_stamp_ns();
  submap.last_stamp_ns = record.last_stamp_ns();
  submap.odom_from_submap = pose_of(record.odom_from_submap());
  submap.previous_from_submap.pose = pose_of(record.previous_from_submap());
  for (int i = 0; i < 9; ++i)
    submap.previous_from_submap.covariance(i / 3, i % 3) =
        record.previous_from_submap_covariance(i);
  submap.submap_from_base_at_end = pose_of(record.submap_from_base_at_end());
  submap.travelled_m = record.travelled_m();
  submap.cell_size_m = record.cell_size_m();
  submap.min_x_m = record.min_x_m();
  submap.min_y_m = record.min_y_m();
  submap.columns = record.columns();
  submap.rows = record.rows();
  submap.so_log_odds.resize(record.so_log_odds().size());
  std::ranges::copy(record.so_log_odds(), submap.so_log_odds.begin());
  submap.mo_evidence.resize(record.mo_evidence().size());
  std::ranges::transform(record.mo_evidence(), submap.mo_evidence.begin(),
                         [](char c) { return static_cast<std::uint8_t>(c); });
  submap.surfels.resize(static_cast<std::size_t>(record.surfel_x_m_size()));
  for (int i = 0; i < record.surfel_x_m_size(); ++i) {
    submap.surfels[static_cast<std::size_t>(i)] = {
        record.surfel_x_m(i), record.surfel_y_m(i), record.surfel_normal_x(i),
        record.surfel_normal_y(i), record.surfel_weight(i)};
  }
  submap.saliency = record.saliency();
  read_measurements(record, submap);
  return submap;
}

}  // namespace

std::string to_blob(const flow::Submap& submap) {
  return deflated(to_record(submap).SerializeAsString());
}

std::optional<flow::Submap> from_blob(std::string_view blob) {
  const std::optional<std::string> bytes = inflated(blob);
  SubmapRecord record;
  if (!bytes || !record.ParseFromString(*bytes) || !is_consistent(record)) return std::nullopt;
  return from_record(record);
}

}  // namespace slammot::map_store
