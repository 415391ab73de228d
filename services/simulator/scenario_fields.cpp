#include "services/simulator/scenario_fields.hpp"

#include <numbers>

namespace slammot::simulator {
namespace {

using namespace simulation;
using config::FieldTable;
using config::kNotNegative;
using config::kPositive;
using config::kShare;
using config::list_of;
using config::Range;
using config::with_nested;

constexpr Range kAnyAngle{-2.0 * std::numbers::pi, 2.0 * std::numbers::pi};
constexpr Range kCount{0, 10000};
constexpr Range kMetres{-1e5, 1e5};

FieldTable<CityConfig> city_fields() {
  return {
      {"blocks_east", &CityConfig::blocks_east, "Number of blocks from west to east.", {1, 30}},
      {"blocks_north", &CityConfig::blocks_north, "Number of blocks from south to north.", {1, 30}},
      {"block_pitch_m",
       &CityConfig::block_pitch_m,
       "Mean distance between neighbouring streets.",
       {50, 500}},
      {"pitch_variation",
       &CityConfig::pitch_variation,
       "Greatest deviation of that distance, as a share of it.",
       {0, 0.5}},
      {"bend_m", &CityConfig::bend_m, "Amplitude of the sinusoidal course of streets.", {0, 10}},
      {"bend_length_m",
       &CityConfig::bend_length_m,
       "Wavelength of the course of streets.",
       {100, 1e5}},
      {"lane_offset_m", &CityConfig::lane_offset_m,
       "Distance of lane centres from the centre of the street.", kPositive},
      {"bicycle_offset_m", &CityConfig::bicycle_offset_m,
       "Distance of bicycles from the centre of the street.", kPositive},
      {"parking_offset_m", &CityConfig::parking_offset_m,
       "Distance of parked cars from the centre of the street.", kPositive},
      {"curb_m", &CityConfig::curb_m, "Distance of the kerb from the centre of the street.",
       kPositive},
      {"front_m", &CityConfig::front_m,
       "Least distance of buildings from the centre of the street.", kPositive},
      {"stop_line_m", &CityConfig::stop_line_m,
       "Distance of stop lines from the centre of the junction.", kPositive},
      {"signalled_share", &CityConfig::signalled_share,
       "Share of junctions with traffic lights; at the others the first to arrive has priority.",
       kShare},
      {"parked_share", &CityConfig::parked_share, "Share of the kerb with parked cars.", kShare},
      {"tree_spacing_m", &CityConfig::tree_spacing_m, "Distance between the trees of a street.",
       kPositive},
      {"lamp_spacing_m", &CityConfig::lamp_spacing_m,
       "Distance between the lamp posts of a street.", kPositive},
      {"park_share", &CityConfig::park_share,
       "Share of blocks with trees and bushes instead of buildings.", kShare},
      {"gap_share", &CityConfig::gap_share,
       "Share of a block's side without buildings: alleys and car parks.", kShare},
  };
}

FieldTable<JunctionId> junction_fields() {
  return {{"column", &JunctionId::column, "Column of junctions, from the west, from 0.", {0, 30}},
          {"row", &JunctionId::row, "Row of junctions, from the south, from 0.", {0, 30}}};
}

FieldTable<OfficeCorner> office_corner_fields() {
  return {
      {"column",
       &OfficeCorner::column,
       "Corridor that runs north, from the west, from 0.",
       {0, 30}},
      {"row", &OfficeCorner::row, "0: the southern corridor, 1: the northern corridor.", {0, 1}}};
}

FieldTable<TrafficConfig> traffic_fields() {
  return {
      {"cars", &TrafficConfig::cars, "Number of cars; fewer if the streets are full.", kCount},
      {"trucks", &TrafficConfig::trucks, "Number of trucks.", kCount},
      {"buses", &TrafficConfig::buses, "Number of buses.", kCount},
      {"bicycles", &TrafficConfig::bicycles, "Number of bicycles.", kCount},
      {"stopping_share", &TrafficConfig::stopping_share,
       "Share of cars and trucks that stop in the lane occasionally.", kShare},
      list_of("car_ahead", &TrafficConfig::car_ahead, junction_fields(),
              "Corners of the path of a stop-and-go car directly ahead of the vehicle."),
      {"green_s", &TrafficConfig::green_s, "Duration of green of each axis of a junction.",
       kPositive},
      {"clearance_s", &TrafficConfig::clearance_s, "Duration of red for all after each green.",
       kNotNegative},
      {"varied_sizes", &TrafficConfig::varied_sizes,
       "Cars from 3.4 to 5.3 m, vans, trucks from 6 to 16.5 m and buses from 8 to 18 m."},
  };
}

FieldTable<RouteConfig> route_fields() {
  return {
      list_of("junctions", &RouteConfig::junctions, junction_fields(),
              "Corners of the vehicle's route, joined by straight streets; random after the last."),
      {"start_m", &RouteConfig::start_m,
       "Distance of the start before the stop line of the first junction.", kPositive},
      {"speed_factor", &RouteConfig::speed_factor, "Speed as a multiple of the limit.", {0.1, 3}},
      {"hard_brake_every_s", &RouteConfig::hard_brake_every_s,
       "Mean time between emergency stops of the vehicle; 0: none.", kNotNegative},
      {"hard_brake_mps2", &RouteConfig::hard_brake_mps2, "Deceleration of an emergency stop.",
       kNotNegative},
      {"length_m", &RouteConfig::length_m, "Length of the vehicle.", kPositive},
      {"width_m", &RouteConfig::width_m, "Width of the vehicle.", kPositive},
  };
}

FieldTable<WalkersConfig> walkers_fields() {
  return {
      {"pedestrians", &WalkersConfig::pedestrians, "Number of pedestrians.", kCount},
      {"speed_mps", &WalkersConfig::speed_mps, "Mean speed.", kPositive},
      {"speed_sigma_mps", &WalkersConfig::speed_sigma_mps,
       "One sigma of the speed over pedestrians.", kNotNegative},
      {"runner_share", &WalkersConfig::runner_share, "Share of runners among single pedestrians.",
       kShare},
      {"pair_share", &WalkersConfig::pair_share,
       "Share of groups with two pedestrians side by side.", kShare},
      {"trio_share", &WalkersConfig::trio_share,
       "Share of groups with three pedestrians side by side.", kShare},
      {"pause_every_s", &WalkersConfig::pause_every_s, "Mean time between pauses.", kPositive},
      {"pause_s", &WalkersConfig::pause_s, "Longest pause.", kNotNegative},
      {"sideways_m", &WalkersConfig::sideways_m,
       "Greatest distance from the centre of the pavement or corridor.", kNotNegative},
      {"step_aside_m", &WalkersConfig::step_aside_m, "Sidestep for a passing vehicle.",
       kNotNegative},
  };
}

FieldTable<OfficeConfig> office_fields() {
  return {
      {"length_m", &OfficeConfig::length_m, "Length of the ring of corridors from west to east.",
       kPositive},
      {"depth_m", &OfficeConfig::depth_m, "Length of the ring of corridors from south to north.",
       kPositive},
      {"cross_corridors",
       &OfficeConfig::cross_corridors,
       "Number of corridors across the ring.",
       {0, 20}},
      {"corridor_m", &OfficeConfig::corridor_m, "Width of a corridor.", kPositive},
      {"open_door_share", &OfficeConfig::open_door_share, "Share of open doors.", kShare},
      {"furniture_share", &OfficeConfig::furniture_share,
       "Share of occupied places along a room's walls.", kShare},
      {"corridor_furniture_per_m", &OfficeConfig::corridor_furniture_per_m,
       "Objects per metre of corridor.", kNotNegative},
  };
}

FieldTable<RobotConfig> robot_fields() {
  return {
      {"speed_mps", &RobotConfig::speed_mps, "Speed in corridors.", kPositive},
      {"turning_speed_mps", &RobotConfig::turning_speed_mps, "Speed in turns.", kPositive},
      {"acceleration_mps2", &RobotConfig::acceleration_mps2,
       "Acceleration, and a third of the deceleration.", kPositive},
      {"bend_m", &RobotConfig::bend_m, "Distance from the beginning of a turn to the corner.",
       kPositive},
      {"diameter_m", &RobotConfig::diameter_m, "Diameter of the robot.", kPositive},
      {"keep_clear_m", &RobotConfig::keep_clear_m,
       "Distance to a person ahead at which the robot stops.", kNotNegative},
  };
}

FieldTable<PlaceInWorld> place_fields() {
  return {{"x_m", &PlaceInWorld::x_m, "East, in world.", kMetres},
          {"y_m", &PlaceInWorld::y_m, "North, in world.", kMetres}};
}

FieldTable<SpeedAt> speed_fields() {
  return {{"at_s", &SpeedAt::at_s, "Time since the first scan."},
          {"mps", &SpeedAt::mps, "Speed at that time.", {0, 100}}};
}

FieldTable<ScriptedObject> object_fields() {
  return {
      {"kind", &ScriptedObject::kind, "Class of the object."},
      {"length_m", &ScriptedObject::length_m, "0: typical of the class.", kNotNegative},
      {"width_m", &ScriptedObject::width_m, "0: typical of the class.", kNotNegative},
      list_of("way", &ScriptedObject::way, place_fields(),
              "Points on the path of its centre, joined by straight lines; a single point: "
              "stationary."),
      {"heading_rad", &ScriptedObject::heading_rad, "Heading of a stationary object.", kAnyAngle},
      {"bend_m", &ScriptedObject::bend_m, "Distance from the beginning of a turn to the corner.",
       kPositive},
      list_of("speed", &ScriptedObject::speed, speed_fields(),
              "Speeds, interpolated linearly in time; none: stationary."),
      {"from_s", &ScriptedObject::from_s, "Time at which the object appears."},
      {"until_s", &ScriptedObject::until_s, "Time at which the object disappears."},
      {"carries_scanner", &ScriptedObject::carries_scanner,
       "A further vehicle with scanners and its own log."},
      {"copies", &ScriptedObject::copies, "Number of copies with random variations.", {1, 500}},
      {"ahead_variation_m", &ScriptedObject::ahead_variation_m,
       "Greatest variation of the start along the path.", kNotNegative},
      {"sideways_variation_m", &ScriptedObject::sideways_variation_m,
       "Greatest lateral distance from the path.", kNotNegative},
      {"speed_variation", &ScriptedObject::speed_variation,
       "Greatest variation of the speed, as a share of it.", kShare},
  };
}

FieldTable<ScriptedFront> front_fields() {
  return {
      list_of("along", &ScriptedFront::along, place_fields(),
              "Corners of the front; projections extend to the left of its direction."),
      {"bay_m", &ScriptedFront::bay_m, "Mean width of projections and recesses.", kPositive},
      {"depth_m", &ScriptedFront::depth_m, "Greatest depth of projections; 0: a plane wall.",
       kNotNegative},
      {"gap_share", &ScriptedFront::gap_share, "Share of gaps.", kShare},
  };
}

FieldTable<ScriptedRow> row_fields() {
  FieldTable<ScriptedRow> table = {
      {"of", &ScriptedRow::of, "Kind of object."},
      {"spacing_m", &ScriptedRow::spacing_m,
       "Distance between objects; 0: a single object at `from`.", kNotNegative},
      {"variation_m", &ScriptedRow::variation_m, "Greatest variation of the position.",
       kNotNegative},
      {"radius_m", &ScriptedRow::radius_m, "Radius of posts and bushes.", kPositive},
  };
  table = with_nested(std::move(table), "from", &ScriptedRow::from, place_fields());
  return with_nested(std::move(table), "to", &ScriptedRow::to, place_fields());
}

FieldTable<ScriptConfig> script_fields() {
  FieldTable<ScriptConfig> table = {
      list_of("objects", &ScriptConfig::objects, object_fields(), "All other movable objects."),
      list_of("fronts", &ScriptConfig::fronts, front_fields(), "House fronts and walls."),
      list_of("rows", &ScriptConfig::rows, row_fields(), "Rows of posts, bushes or parked cars."),
  };
  return with_nested(std::move(table), "vehicle", &ScriptConfig::vehicle, object_fields());
}

FieldTable<HeightAt> height_fields() {
  return {{"x_m", &HeightAt::x_m, "East, in world, ascending.", kMetres},
          {"z_m", &HeightAt::z_m, "Height of the road.", kMetres}};
}

FieldTable<SuspensionConfig> suspension_fields() {
  return {
      {"pitch_per_mps2_rad", &SuspensionConfig::pitch_per_mps2_rad,
       "Static pitch per acceleration.", kNotNegative},
      {"frequency_hz",
       &SuspensionConfig::frequency_hz,
       "Natural frequency of the pitch.",
       {0.1, 5}},
      {"damping_ratio", &SuspensionConfig::damping_ratio, "Damping ratio of the pitch.", {0, 2}},
  };
}

FieldTable<OdometryConfig> odometry_fields() {
  return {
      {"scale_error_low", &OdometryConfig::scale_error_low,
       "Least magnitude of the relative scale error.", kNotNegative},
      {"scale_error_high", &OdometryConfig::scale_error_high,
       "Greatest magnitude of the relative scale error.", kNotNegative},
      {"distance_noise", &OdometryConfig::distance_noise,
       "One sigma of the length of a step, as a share of it.", kNotNegative},
      {"heading_noise_rad", &OdometryConfig::heading_noise_rad,
       "One sigma of the rotation of a step, while moving.", kNotNegative},
      {"rate_bias_sigma_radps", &OdometryConfig::rate_bias_sigma_radps,
       "One sigma of the bias of the heading rate, constant during a drive.", kNotNegative},
      {"rate_bias_walk_radps", &OdometryConfig::rate_bias_walk_radps,
       "One sigma of the drift of that bias in one second.", kNotNegative},
  };
}

FieldTable<ScannerConfig> scanner_fields() {
  return {
      {"scanner_id", &ScannerConfig::scanner_id, "Name of the scanner."},
      {"ahead_m", &ScannerConfig::ahead_m, "Position forward of the vehicle's centre.", kMetres},
      {"left_m", &ScannerConfig::left_m, "Position to the left of the vehicle's centre.", kMetres},
      {"heading_rad", &ScannerConfig::heading_rad,
       "Heading of the scanner in base, counter-clockwise.", kAnyAngle},
      {"nose_down_rad", &ScannerConfig::nose_down_rad, "Pitch of the scanner, positive down.",
       kAnyAngle},
      {"left_up_rad", &ScannerConfig::left_up_rad,
       "Roll of the scanner to the right; 1.5708: a vertical profile.", kAnyAngle},
      {"height_m", &ScannerConfig::height_m, "Height above the road.", kPositive},
      {"beams", &ScannerConfig::beams, "Beams per scan.", {2, 8192}},
      {"first_beam_rad", &ScannerConfig::first_beam_rad,
       "Direction of the first beam from the scanner's heading, counter-clockwise.", kAnyAngle},
      {"field_of_view_rad", &ScannerConfig::field_of_view_rad,
       "Angle from the first to the last beam.", kAnyAngle},
      {"rate_hz", &ScannerConfig::rate_hz, "Scans per second.", {1, 200}},
      {"delay_s",
       &ScannerConfig::delay_s,
       "Delay of a further scanner's first scan after that of the first scanner.",
       {0, 10}},
      {"sweep_s", &ScannerConfig::sweep_s, "Time from the first to the last beam.", kNotNegative},
      {"max_range_m", &ScannerConfig::max_range_m, "Greatest range, and the reading without echo.",
       kPositive},
      {"resolution_m", &ScannerConfig::resolution_m, "Resolution of readings.", kPositive},
      {"noise", &ScannerConfig::noise,
       "Noise of ranges: AS_GIVEN (the next two settings), DATA_SHEET (0.01 m) or CONSERVATIVE (1 "
       "% of the range)."},
      {"noise_floor_m", &ScannerConfig::noise_floor_m, "One sigma of a range at range zero.",
       kNotNegative},
      {"noise_per_m", &ScannerConfig::noise_per_m, "Increase of sigma per metre of range.",
       kNotNegative},
      {"spot_rad", &ScannerConfig::spot_rad, "Full width of a beam.", kNotNegative},
      {"mixed_share", &ScannerConfig::mixed_share,
       "Share of mixed pixels among the beams that hit two surfaces.", kShare},
      {"drop_out", &ScannerConfig::drop_out, "Probability of a lost echo at range zero.", kShare},
      {"dark_drop_out", &ScannerConfig::dark_drop_out,
       "Probability of a lost echo from a car at maximum range; proportional to the square of the "
       "range.",
       kShare},
  };
}

FieldTable<GnssConfig> gnss_fields() {
  return {
      {"rate_hz",
       &GnssConfig::rate_hz,
       "Fixes per second, at most one per scan; 0: no receiver.",
       {0, 100}},
      {"latitude_deg",
       &GnssConfig::latitude_deg,
       "Latitude of the world's origin; x points east.",
       {-80, 80}},
      {"longitude_deg",
       &GnssConfig::longitude_deg,
       "Longitude of the world's origin.",
       {-180, 180}},
      {"altitude_m", &GnssConfig::altitude_m, "Altitude of the world's origin.", kMetres},
      {"satellites", &GnssConfig::satellites, "Satellites above the horizon.", {0, 100}},
      {"lowest_rad", &GnssConfig::lowest_rad, "Least elevation of a used satellite.", {0.01, 1.5}},
      {"building_height_m", &GnssConfig::building_height_m,
       "Height of walls, which occlude satellites.", kNotNegative},
      {"antenna_height_m", &GnssConfig::antenna_height_m, "Height of the antenna above the road.",
       kNotNegative},
      {"range_error_m", &GnssConfig::range_error_m,
       "One sigma of the white range error of a satellite.", kNotNegative},
      {"wander_m", &GnssConfig::wander_m, "One sigma of the atmospheric error per axis.",
       kNotNegative},
      {"wander_s", &GnssConfig::wander_s, "Correlation time of the atmospheric error.", kPositive},
      {"multipath_m", &GnssConfig::multipath_m,
       "One sigma of the multipath error per axis, times the share of occluded satellites.",
       kNotNegative},
      {"multipath_length_m", &GnssConfig::multipath_length_m,
       "Correlation length of the multipath error.", kPositive},
  };
}

FieldTable<CompassConfig> compass_fields() {
  return {
      {"rate_hz",
       &CompassConfig::rate_hz,
       "Readings per second, at most one per scan; 0: no compass.",
       {0, 200}},
      {"noise_rad", &CompassConfig::noise_rad, "One sigma of the white noise of a reading.",
       kNotNegative},
      {"bias_sigma_rad", &CompassConfig::bias_sigma_rad,
       "One sigma of the bias by mounting and vehicle, constant during a drive.", kNotNegative},
      {"disturbance_rad", &CompassConfig::disturbance_rad,
       "One sigma of the disturbance by iron in the surroundings.", kNotNegative},
      {"disturbance_length_m", &CompassConfig::disturbance_length_m,
       "Correlation length of that disturbance.", kPositive},
  };
}

FieldTable<ImuConfig> imu_fields() {
  return {
      {"rate_hz", &ImuConfig::rate_hz, "Readings per second; 0: no IMU.", {0, 2000}},
      {"noise_radps", &ImuConfig::noise_radps, "One sigma of the white noise of a reading.",
       kNotNegative},
      {"bias_sigma_radps", &ImuConfig::bias_sigma_radps,
       "One sigma of the bias at the start of a drive.", kNotNegative},
      {"bias_walk_radps", &ImuConfig::bias_walk_radps,
       "One sigma of the bias's random walk over a second.", kNotNegative},
      {"scale_sigma", &ImuConfig::scale_sigma,
       "One sigma of the relative scale error, constant during a drive.", kNotNegative},
  };
}

}  // namespace

FieldTable<ScenarioConfig> scenario_fields() {
  FieldTable<ScenarioConfig> table = {
      {"description", &ScenarioConfig::description, "One line of description."},
      {"seed", &ScenarioConfig::seed, "Seed of all random numbers."},
      {"duration_s", &ScenarioConfig::duration_s, "Duration of the recording.", kPositive},
      {"start_stamp_s", &ScenarioConfig::start_stamp_s, "Stamp of the first scan.", kNotNegative},
      {"warm_up_s", &ScenarioConfig::warm_up_s, "Simulated time before the first scan.",
       kNotNegative},
      {"place", &ScenarioConfig::place, "Kind of world: CITY, OFFICE or SCRIPT."},
      {"profile", &ScenarioConfig::profile, "Profile that suits the drive."},
      {"log_record", &ScenarioConfig::log_record, "CARMEN record of scans in the log."},
      list_of("robot_way", &ScenarioConfig::robot_way, office_corner_fields(),
              "Corners of the robot's path, in order."),
      list_of("terrain", &ScenarioConfig::terrain, height_fields(),
              "Height of the road from west to east; empty: level."),
      list_of("more_scanners", &ScenarioConfig::more_scanners, scanner_fields(),
              "Further scanners, each with its own id."),
      {"sumo_fcd", &ScenarioConfig::sumo_fcd,
       "File with the traffic of a script, written by Eclipse SUMO with --fcd-output."},
      {"sumo_vehicle", &ScenarioConfig::sumo_vehicle,
       "Vehicle of that traffic that carries the scanners; empty: the script's own vehicle."},
      {"ride",
       &ScenarioConfig::ride,
       "Index of the script's vehicle whose scanners are simulated; 0: `vehicle`.",
       {0, 100}},
  };
  table = with_nested(std::move(table), "city", &ScenarioConfig::city, city_fields());
  table = with_nested(std::move(table), "traffic", &ScenarioConfig::traffic, traffic_fields());
  table = with_nested(std::move(table), "route", &ScenarioConfig::route, route_fields());
  table = with_nested(std::move(table), "walkers", &ScenarioConfig::walkers, walkers_fields());
  table = with_nested(std::move(table), "office", &ScenarioConfig::office, office_fields());
  table = with_nested(std::move(table), "robot", &ScenarioConfig::robot, robot_fields());
  table = with_nested(std::move(table), "script", &ScenarioConfig::script, script_fields());
  table =
      with_nested(std::move(table), "suspension", &ScenarioConfig::suspension, suspension_fields());
  table = with_nested(std::move(table), "odometry", &ScenarioConfig::odometry, odometry_fields());
  table = with_nested(std::move(table), "gnss", &ScenarioConfig::gnss, gnss_fields());
  table = with_nested(std::move(table), "compass", &ScenarioConfig::compass, compass_fields());
  table = with_nested(std::move(table), "imu", &ScenarioConfig::imu, imu_fields());
  return with_nested(std::move(table), "scanner", &ScenarioConfig::scanner, scanner_fields());
}

}  // namespace slammot::simulator
