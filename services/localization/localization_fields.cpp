#include "services/localization/localization_fields.hpp"

#include <utility>

#include "common/config/physical_ranges.hpp"
#include "services/localization/localizer_presets.hpp"
#include "services/localization/map_fields.hpp"
#include "services/localization/odometry_fields.hpp"

namespace slammot::localization {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::kLength_m;
using config::kLengthOrZero_m;
using config::kNotNegative;
using config::kPositive;
using config::Range;
using config::with_members_of;
using config::with_nested;

FieldTable<EchoConfig> sensor_fields() {
  using C = EchoConfig;
  return {
      {"match_range_m",
       &C::match_range_m,
       "Farther echoes are not matched.",
       kLength_m,
       {"Open places leave too few echoes to match.",
        "Distant echoes with systematic errors pull the pose."}},
      {"min_range_m",
       &C::min_range_m,
       "Nearer echoes come from the vehicle itself.",
       kLengthOrZero_m,
       {"The vehicle maps its own body.", "What is near is not seen."}},
      {"range_noise_m",
       &C::range_noise_m,
       "One sigma of a range, for the match.",
       kLength_m,
       {"The pose follows noise.", "Wheels outweigh the scans."}},
      {"sweep_factor_sigma",
       &C::sweep_factor_sigma,
       "One sigma of the factor on the duration of a sweep; 0: it is as configured.",
       kNotNegative,
       {"A sweep that runs the other way bends the map in turns.", "The factor follows noise."}},
  };
}

FieldTable<EchoConfig> map_use_fields() {
  using C = EchoConfig;
  return {
      {"map_range_m",
       &C::map_range_m,
       "Farther echoes are not mapped.",
       kLength_m,
       {"Distant walls are missing, and the heading drifts.", "Distant echoes smear the map."}},
      {"leave_out_moving", &C::leave_out_moving,
       "Off to measure its worth: everything is mapped and matched as stationary."},
  };
}

FieldTable<MatchTrustConfig> trust_fields() {
  using C = MatchTrustConfig;
  return {{"body_sigma_without_wheels_m",
           &C::body_sigma_without_wheels_m,
           "Without odometry: one sigma of the error that all points of one body share; 0: none.",
           kLengthOrZero_m,
           {"One large mover carries the pose along.",
            "One wall beside the vehicle counts for little."}}};
}

FieldTable<RecoveryConfig> lost_fields() {
  using C = RecoveryConfig;
  return {{"lost_after_s",
           &C::lost_after_s,
           "Time without a match that odometry bridges; then the pose is searched for.",
           kNotNegative,
           {"Traffic around the vehicle starts a search.",
            "Poses are wrong for as long after the vehicle was set down elsewhere."}}};
}

FieldTable<matching::PointToLineConfig> match_fields() {
  using C = matching::PointToLineConfig;
  return {
      {"coarse_gate_m",
       &C::coarse_gate_m,
       "Largest distance of a point from its surfel in the first steps.",
       Range{0.01, 10.0},
       {"A prediction that is off is not corrected.", "Points match other walls."}},
      {"fine_gate_m",
       &C::fine_gate_m,
       "Largest distance of a point from its surfel in the last steps.",
       Range{0.01, 10.0},
       {"Matches lose good points.", "Points beyond the end of a wall pull the pose back."}},
      {"robust_scale_m",
       &C::robust_scale_m,
       "Residual at which the weight of a point is a quarter.",
       kLength_m,
       {"Good points of rough walls lose their weight.", "Movers and bushes pull the pose."}},
  };
}

FieldTable<PoseErrorConfig> drift_fields() {
  using C = PoseErrorConfig;
  constexpr config::Consequences kDrift{
      "Revisits are looked for too near, and closures are refused.",
      "Searches take long, and look-alikes are found."};
  return {
      {"drift_m_per_sqrt_m", &C::drift_m_per_sqrt_m,
       "One sigma of the position that matching adds along the way, for the graph and the search "
       "for revisits.",
       kPositive, kDrift},
      {"drift_rad_per_sqrt_m", &C::drift_rad_per_sqrt_m, "The same for the heading.", kPositive,
       kDrift},
  };
}

FieldTable<RecoveryConfig> astray_fields() {
  using C = RecoveryConfig;
  return {{"astray_sigma_m",
           &C::astray_sigma_m,
           "One sigma of the tie between two maps where the vehicle lost its way.",
           Range{1.0, 900.0},
           {"The place where it was set down lies outside of the search.", "Searches take long."}}};
}

config::Field<LocalizerConfig> pose_error_model_field() {
  return {"pose_error_model",
          [](LocalizerConfig& config) -> config::Value {
            return config::Choice{[&config] { return static_cast<int>(config.pose_error_model); },
                                  [&config](int number) {
                                    set_pose_error_model(config,
                                                         static_cast<PoseErrorModel>(number));
                                  }};
          },
          "Model of the errors of published poses: road, building or model_cars "
          "(docs/decisions/pose-covariance.md).",
          {}};
}

FieldTable<EchoConfig> expectation_fields() {
  return {{"expects_all_ranges", &EchoConfig::expects_all_ranges,
           "Publishes the expected range of every beam, for another detection; ours needs those of "
           "near echoes that contradict the map."}};
}

FieldTable<EchoConfig> echo_fields() {
  using C = EchoConfig;
  return config::joined<C>({in_group<C>(Group::sensor, sensor_fields()),
                            in_group<C>(Group::map, map_use_fields()),
                            in_group<C>(Group::publication, expectation_fields())});
}

FieldTable<RecoveryConfig> recovery_fields() {
  using C = RecoveryConfig;
  return config::joined<C>(
      {in_group<C>(Group::matching, lost_fields()), in_group<C>(Group::closing, astray_fields())});
}

/// Settings that text writes as fields of the stage itself.
FieldTable<LocalizerConfig> own_fields() {
  using C = LocalizerConfig;
  FieldTable<C> fields =
      config::joined<C>({in_group<C>(Group::odometry, {vehicle_field()}),
                         in_group<C>(Group::publication, {pose_error_model_field()})});
  fields = with_members_of<C>(std::move(fields), &C::echoes, echo_fields());
  fields = with_members_of<C>(std::move(fields), &C::odometry, odometry_fields());
  fields =
      with_members_of<C>(std::move(fields), &C::trust, in_group(Group::matching, trust_fields()));
  fields = with_members_of<C>(std::move(fields), &C::recovery, recovery_fields());
  return with_members_of<C>(std::move(fields), &C::errors,
                            in_group(Group::closing, drift_fields()));
}

}  // namespace

const FieldTable<LocalizerConfig>& localization_fields() {
  using C = LocalizerConfig;
  static const FieldTable<C> table = [] {
    FieldTable<C> fields = with_nested<C>(own_fields(), "map", &C::map, map_fields());
    fields = with_nested<C>(std::move(fields), "belief", &C::belief, belief_fields());
    fields = with_nested<C>(std::move(fields), "motion", &C::motion, motion_fields());
    return with_nested<C>(std::move(fields), "match", &C::match,
                          in_group(Group::matching, match_fields()));
  }();
  return table;
}

}  // namespace slammot::localization
