#include "services/localization/odometry_fields.hpp"

#include <string>

#include "common/config/physical_ranges.hpp"
#include "services/localization/localizer_presets.hpp"

namespace slammot::localization {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::kPositive;
using config::kSpeed_mps;

FieldTable<OdometryConfig> trust_in_odometry_fields() {
  using C = OdometryConfig;
  return {
      {"use_odometry", &C::use_odometry,
       "Off for wheels that are worse than none: constant velocity predicts."},
      {"fastest_mps",
       &C::fastest_mps,
       "A faster step by odometry is a jump.",
       kSpeed_mps,
       {"Fast driving is taken for a jump.", "Jumps are believed."}},
      {"may_be_picked_up", &C::may_be_picked_up,
       "The vehicle may be set down elsewhere without a sign of its wheels."},
  };
}

FieldTable<OdometryConfig> clock_fields() {
  return {{"time_is_known", &OdometryConfig::time_is_known,
           "Off where stamps are made up, so that no speed has a meaning."}};
}

}  // namespace

config::Field<LocalizerConfig> vehicle_field() {
  return {"vehicle",
          [](LocalizerConfig& config) -> config::Value {
            return config::Choice{
                [&config] { return static_cast<int>(config.vehicle); },
                [&config](int number) { set_vehicle(config, static_cast<Vehicle>(number)); }};
          },
          "Kind of the vehicle. car: steered, fast, many scans per metre, its scanner pitches. "
          "robot: slow, few scans per metre, turns about its middle, its wheels slip.",
          {}};
}

FieldTable<OdometryConfig> odometry_fields() {
  using C = OdometryConfig;
  return config::joined<C>({in_group<C>(Group::odometry, trust_in_odometry_fields()),
                            in_group<C>(Group::log, clock_fields())});
}

FieldTable<sensing::MotionModelConfig> motion_fields() {
  using C = sensing::MotionModelConfig;
  return in_group<C>(Group::odometry,
                     {{"speed_walk_mps",
                       &C::speed_walk_mps,
                       "Without odometry: random walk of the speed [m/s per sqrt(s)].",
                       kSpeed_mps,
                       {"Braking is not followed.", "Corridors are shortened."}}});
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
