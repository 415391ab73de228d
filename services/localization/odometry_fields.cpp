#include "services/localization/odometry_fields.hpp"

#include <string>

#include "services/localization/localizer_presets.hpp"

namespace slammot::localization {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::kNotNegative;
using config::kPositive;

config::Field<LocalizerConfig> vehicle_field() {
  return {"vehicle",
          [](LocalizerConfig& config) -> config::Value {
            return config::Choice{
                [&config] { return static_cast<int>(config.vehicle); },
                [&config](int number) { set_vehicle(config, static_cast<Vehicle>(number)); }};
          },
          "Kind of the vehicle. car: steered, fast, its scanner pitches. robot: slow, turns about "
          "its middle.",
          {}};
}

FieldTable<sensing::MotionModelConfig> wheel_noise_fields() {
  using C = sensing::MotionModelConfig;
  return {
      {"position_noise_per_m",
       &C::position_noise_per_m,
       "One sigma of the length of a step by wheels, for each metre.",
       kNotNegative,
       {"Slip is believed.", "Corridors are shortened or stretched."}},
      {"sideways_noise_per_m",
       &C::sideways_noise_per_m,
       "One sigma of its direction across the vehicle, for each metre.",
       kNotNegative,
       {"A robot that skids is believed not to.",
        "Wheels do not hold a road vehicle in its lane where scans say little."}},
      {"heading_noise_per_m",
       &C::heading_noise_per_m,
       "One sigma of its turn, for each metre [rad/m].",
       kNotNegative,
       {"Scans cannot correct the heading on straight ways.",
        "The heading wanders where scans say little."}},
      {"heading_noise_per_rad",
       &C::heading_noise_per_rad,
       "One sigma of its turn, for each radian.",
       kNotNegative,
       {"Wheels that slip in turns are believed.", "Turns in the open are lost."}},
      {"speed_walk_mps",
       &C::speed_walk_mps,
       "Without odometry: random walk of the speed [m/s per sqrt(s)].",
       kPositive,
       {"Braking is not followed.", "Corridors are shortened."}},
  };
}

FieldTable<sensing::MotionModelConfig> motion_from_log_fields() {
  using C = sensing::MotionModelConfig;
  return {{"scale_prior",
           &C::scale_prior,
           "One sigma of the factor on wheel distance. Raised where the log sets way_at_start.",
           kNotNegative,
           {"A wrong wheel radius stretches the map along the way.", "The factor follows noise."}}};
}

}  // namespace

FieldTable<LocalizerConfig> odometry_fields() {
  using C = LocalizerConfig;
  return {
      vehicle_field(),
      {"use_odometry", &C::use_odometry,
       "Off for wheels that are worse than none: constant velocity predicts."},
      {"fastest_mps",
       &C::fastest_mps,
       "A faster step by odometry is a jump.",
       kPositive,
       {"Fast driving is taken for a jump.", "Jumps are believed."}},
      {"longest_step_s",
       &C::longest_step_s,
       "Without odometry the longest extrapolation; longer gaps are counted.",
       kPositive,
       {"The vehicle seems to stop in a gap between scans.",
        "A wrong velocity carries it far in a gap."}},
      {"may_be_picked_up", &C::may_be_picked_up,
       "The vehicle may be set down elsewhere without a sign of its wheels."},
  };
}

FieldTable<sensing::MotionModelConfig> motion_fields() {
  using C = sensing::MotionModelConfig;
  return config::joined<C>({in_group(Group::odometry, wheel_noise_fields()),
                            in_group(Group::log, motion_from_log_fields())});
}

FieldTable<sensing::OdometryBeliefConfig> belief_fields() {
  using C = sensing::OdometryBeliefConfig;
  return in_group<C>(
      Group::log,
      {{"way_at_start",
        &C::way_at_start,
        "Way by scans over way by odometry, as far as pairs of scans show it.",
        kPositive,
        {"The map begins shortened, until the factor is learned.", "It begins stretched."}}});
}

}  // namespace slammot::localization
