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
      {"blocks_east", &CityConfig::blocks_east, "Blocks from west to east.", {1, 30}},
      {"blocks_north", &CityConfig::blocks_north, "Blocks from south to north.", {1, 30}},
      {"block_pitch_m",
       &CityConfig::block_pitch_m,
       "From street to street, before the variation.",
       {50, 500}},
      {"pitch_variation",
       &CityConfig::pitch_variation,
       "Each row and column of blocks differs by up to this share.",
       {0, 0.5}},
      {"bend_m",
       &CityConfig::bend_m,
       "Streets swing this far to either side of straight.",
       {0, 10}},
      {"bend_length_m", &CityConfig::bend_length_m, "Wavelength of that swing.", {100, 1e5}},
      {"lane_offset_m", &CityConfig::lane_offset_m,
       "Middle of a lane from the middle of the street.", kPositive},
      {"bicycle_offset_m", &CityConfig::bicycle_offset_m,
       "Where bicycles go, from the middle of the street.", kPositive},
      {"parking_offset_m", &CityConfig::parking_offset_m,
       "Where cars are parked, from the middle of the street.", kPositive},
      {"curb_m", &CityConfig::curb_m, "The kerb, from the middle of the street.", kPositive},
      {"front_m", &CityConfig::front_m, "Nearest a building comes to the middle of the street.",
       kPositive},
      {"stop_line_m", &CityConfig::stop_line_m, "From the middle of the junction.", kPositive},
      {"signalled_share", &CityConfig::signalled_share,
       "Of the junctions; the others go by who comes first.", kShare},
      {"parked_share", &CityConfig::parked_share, "Of the kerb.", kShare},
      {"tree_spacing_m", &CityConfig::tree_spacing_m, "Between the trees of a street.", kPositive},
      {"lamp_spacing_m", &CityConfig::lamp_spacing_m, "Between the lamps of a street.", kPositive},
      {"park_share", &CityConfig::park_share,
       "Of the blocks: trees and bushes in place of buildings.", kShare},
      {"gap_share", &CityConfig::gap_share,
       "Of a block's side: alleys and car parks between buildings.", kShare},
  };
}

FieldTable<JunctionId> junction_fields() {
  return {{"column", &JunctionId::column, "From the west, from 0.", {0, 30}},
          {"row", &JunctionId::row, "From the south, from 0.", {0, 30}}};
}

FieldTable<OfficeCorner> office_corner_fields() {
  return {{"column",
           &OfficeCorner::column,
           "Of the corridors that run north, from the west, from 0.",
           {0, 30}},
          {"row", &OfficeCorner::row, "0 the southern, 1 the northern corridor.", {0, 1}}};
}

FieldTable<TrafficConfig> traffic_fields() {
  return {
      {"cars", &TrafficConfig::cars, "How many; fewer where the streets are full.", kCount},
      {"trucks", &TrafficConfig::trucks, "How many.", kCount},
      {"buses", &TrafficConfig::buses, "How many.", kCount},
      {"bicycles", &TrafficConfig::bicycles, "How many.", kCount},
      {"stopping_share", &TrafficConfig::stopping_share,
       "Of the cars and trucks: those that stop in the lane now and then.", kShare},
      list_of("car_ahead", &TrafficConfig::car_ahead, junction_fields(),
              "Corners of the way of a car that stops and goes right ahead of the vehicle."),
      {"green_s", &TrafficConfig::green_s, "Of each axis at a signalled junction.", kPositive},
      {"clearance_s", &TrafficConfig::clearance_s, "Red for all after each green.", kNotNegative},
  };
}

FieldTable<RouteConfig> route_fields() {
  return {
      list_of("junctions", &RouteConfig::junctions, junction_fields(),
              "Corners of the vehicle's way, straight streets between; at random after the last."),
      {"start_m", &RouteConfig::start_m, "Behind the stop line of the first junction.", kPositive},
      {"speed_factor", &RouteConfig::speed_factor, "Of the limit.", {0.1, 3}},
      {"hard_brake_every_s", &RouteConfig::hard_brake_every_s,
       "Mean time between frights of the driver; 0: none.", kNotNegative},
      {"hard_brake_mps2", &RouteConfig::hard_brake_mps2, "How hard the vehicle then brakes.",
       kNotNegative},
      {"length_m", &RouteConfig::length_m, "Of the vehicle.", kPositive},
      {"width_m", &RouteConfig::width_m, "Of the vehicle.", kPositive},
  };
}

FieldTable<WalkersConfig> walkers_fields() {
  return {
      {"pedestrians", &WalkersConfig::pedestrians, "How many.", kCount},
      {"speed_mps", &WalkersConfig::speed_mps, "Mean.", kPositive},
      {"speed_sigma_mps", &WalkersConfig::speed_sigma_mps, "How people differ.", kNotNegative},
      {"runner_share", &WalkersConfig::runner_share, "Of those who are alone.", kShare},
      {"pair_share", &WalkersConfig::pair_share, "Of the groups: two side by side.", kShare},
      {"trio_share", &WalkersConfig::trio_share, "Of the groups: three side by side.", kShare},
      {"pause_every_s", &WalkersConfig::pause_every_s, "Mean time between pauses.", kPositive},
      {"pause_s", &WalkersConfig::pause_s, "Longest pause.", kNotNegative},
      {"sideways_m", &WalkersConfig::sideways_m,
       "People keep up to this far from the middle of the way.", kNotNegative},
      {"step_aside_m", &WalkersConfig::step_aside_m,
       "They step this far aside to let a vehicle pass.", kNotNegative},
  };
}

FieldTable<OfficeConfig> office_fields() {
  return {
      {"length_m", &OfficeConfig::length_m, "Of the ring of corridors from west to east.",
       kPositive},
      {"depth_m", &OfficeConfig::depth_m, "Of the ring from south to north.", kPositive},
      {"cross_corridors", &OfficeConfig::cross_corridors, "Between the ring's two ends.", {0, 20}},
      {"corridor_m", &OfficeConfig::corridor_m, "Width of a corridor.", kPositive},
      {"open_door_share", &OfficeConfig::open_door_share, "Of the doors.", kShare},
      {"furniture_share", &OfficeConfig::furniture_share, "Of the places along a room's walls.",
       kShare},
      {"corridor_furniture_per_m", &OfficeConfig::corridor_furniture_per_m,
       "Things that stand in a corridor.", kNotNegative},
  };
}

FieldTable<RobotConfig> robot_fields() {
  return {
      {"speed_mps", &RobotConfig::speed_mps, "In corridors.", kPositive},
      {"turning_speed_mps", &RobotConfig::turning_speed_mps, "In bends.", kPositive},
      {"acceleration_mps2", &RobotConfig::acceleration_mps2, "And a third of its braking.",
       kPositive},
      {"bend_m", &RobotConfig::bend_m, "From where it leaves the straight to the corner.",
       kPositive},
      {"diameter_m", &RobotConfig::diameter_m, "Of the robot.", kPositive},
      {"keep_clear_m", &RobotConfig::keep_clear_m, "Stops for people this near ahead.",
       kNotNegative},
  };
}

FieldTable<PlaceInWorld> place_fields() {
  return {{"x_m", &PlaceInWorld::x_m, "East, in the world frame.", kMetres},
          {"y_m", &PlaceInWorld::y_m, "North, in the world frame.", kMetres}};
}

FieldTable<SpeedAt> speed_fields() {
  return {{"at_s", &SpeedAt::at_s, "After the first scan."},
          {"mps", &SpeedAt::mps, "Speed at that time.", {0, 100}}};
}

FieldTable<ScriptedObject> object_fields() {
  return {
      {"kind", &ScriptedObject::kind, "What it is."},
      {"length_m", &ScriptedObject::length_m, "0: usual for its kind.", kNotNegative},
      {"width_m", &ScriptedObject::width_m, "0: usual for its kind.", kNotNegative},
      list_of(
          "way", &ScriptedObject::way, place_fields(),
          "Places that its centre passes, straight from one to the next; stays at a single one."),
      {"heading_rad", &ScriptedObject::heading_rad, "Of what stays.", kAnyAngle},
      {"bend_m", &ScriptedObject::bend_m,
       "Corners of the way are rounded from this far before them on.", kPositive},
      list_of("speed", &ScriptedObject::speed, speed_fields(),
              "Even change of speed between these times; stands without any."),
      {"from_s", &ScriptedObject::from_s, "In the world from here."},
      {"until_s", &ScriptedObject::until_s, "In the world to here."},
      {"carries_scanner", &ScriptedObject::carries_scanner,
       "A further vehicle, with a log of its own."},
      {"copies",
       &ScriptedObject::copies,
       "The same so many times, with these differences at random.",
       {1, 500}},
      {"ahead_variation_m", &ScriptedObject::ahead_variation_m,
       "Starts up to this far along the way.", kNotNegative},
      {"sideways_variation_m", &ScriptedObject::sideways_variation_m,
       "Moves up to this far beside the way.", kNotNegative},
      {"speed_variation", &ScriptedObject::speed_variation, "Up to this share faster or slower.",
       kShare},
  };
}

FieldTable<ScriptedFront> front_fields() {
  return {
      list_of("along", &ScriptedFront::along, place_fields(),
              "Corners; what stands out goes to the left of the way along them."),
      {"bay_m", &ScriptedFront::bay_m, "Mean width of what stands out or back.", kPositive},
      {"depth_m", &ScriptedFront::depth_m, "How far at most; 0: a plain wall.", kNotNegative},
      {"gap_share", &ScriptedFront::gap_share, "Of the bays: nothing there.", kShare},
  };
}

FieldTable<ScriptedRow> row_fields() {
  FieldTable<ScriptedRow> table = {
      {"of", &ScriptedRow::of, "What stands there."},
      {"spacing_m", &ScriptedRow::spacing_m, "0: one thing, at `from`.", kNotNegative},
      {"variation_m", &ScriptedRow::variation_m, "Each is up to this far from its place.",
       kNotNegative},
      {"radius_m", &ScriptedRow::radius_m, "Of posts and bushes.", kPositive},
  };
  table = with_nested(std::move(table), "from", &ScriptedRow::from, place_fields());
  return with_nested(std::move(table), "to", &ScriptedRow::to, place_fields());
}

FieldTable<ScriptConfig> script_fields() {
  FieldTable<ScriptConfig> table = {
      list_of("objects", &ScriptConfig::objects, object_fields(),
              "Everything else that moves or could."),
      list_of("fronts", &ScriptConfig::fronts, front_fields(), "House fronts and walls."),
      list_of("rows", &ScriptConfig::rows, row_fields(), "Posts, bushes, parked cars."),
  };
  return with_nested(std::move(table), "vehicle", &ScriptConfig::vehicle, object_fields());
}

FieldTable<HeightAt> height_fields() {
  return {{"x_m", &HeightAt::x_m, "East, in the world frame, ascending.", kMetres},
          {"z_m", &HeightAt::z_m, "Height of the road there.", kMetres}};
}

FieldTable<SuspensionConfig> suspension_fields() {
  return {
      {"pitch_per_mps2_rad", &SuspensionConfig::pitch_per_mps2_rad,
       "At rest under constant acceleration.", kNotNegative},
      {"frequency_hz", &SuspensionConfig::frequency_hz, "Of the body on its springs.", {0.1, 5}},
      {"damping_ratio", &SuspensionConfig::damping_ratio, "Of these springs.", {0, 2}},
  };
}

FieldTable<OdometryConfig> odometry_fields() {
  return {
      {"scale_error_low", &OdometryConfig::scale_error_low,
       "Wheel size is wrong by at least this share, either way,", kNotNegative},
      {"scale_error_high", &OdometryConfig::scale_error_high, "and at most by this.", kNotNegative},
      {"distance_noise", &OdometryConfig::distance_noise, "Of each step's length, one sigma.",
       kNotNegative},
      {"heading_noise_rad", &OdometryConfig::heading_noise_rad,
       "Of each step while moving, one sigma.", kNotNegative},
      {"rate_bias_sigma_radps", &OdometryConfig::rate_bias_sigma_radps,
       "Heading rate at rest; drawn once a drive.", kNotNegative},
      {"rate_bias_walk_radps", &OdometryConfig::rate_bias_walk_radps,
       "Its drift in one second, one sigma.", kNotNegative},
  };
}

FieldTable<ScannerConfig> scanner_fields() {
  return {
      {"scanner_id", &ScannerConfig::scanner_id, "Its name."},
      {"ahead_m", &ScannerConfig::ahead_m, "Of the vehicle's centre.", kMetres},
      {"left_m", &ScannerConfig::left_m, "Of the vehicle's centre.", kMetres},
      {"heading_rad", &ScannerConfig::heading_rad,
       "Where it looks, counter-clockwise from straight ahead.", kAnyAngle},
      {"nose_down_rad", &ScannerConfig::nose_down_rad, "Tipped forward.", kAnyAngle},
      {"left_up_rad", &ScannerConfig::left_up_rad,
       "Tipped to its right; 1.5708 scans a vertical profile.", kAnyAngle},
      {"height_m", &ScannerConfig::height_m, "Above the road.", kPositive},
      {"beams", &ScannerConfig::beams, "In a scan.", {2, 8192}},
      {"first_beam_rad", &ScannerConfig::first_beam_rad,
       "Direction of the first beam, counter-clockwise from straight ahead.", kAnyAngle},
      {"field_of_view_rad", &ScannerConfig::field_of_view_rad, "From the first to the last beam.",
       kAnyAngle},
      {"rate_hz", &ScannerConfig::rate_hz, "Scans in a second.", {1, 200}},
      {"delay_s",
       &ScannerConfig::delay_s,
       "Of a further scanner's first scan behind that of the first one.",
       {0, 10}},
      {"sweep_s", &ScannerConfig::sweep_s, "From the first to the last beam.", kNotNegative},
      {"max_range_m", &ScannerConfig::max_range_m, "Reading for no echo.", kPositive},
      {"resolution_m", &ScannerConfig::resolution_m, "Step of the readings.", kPositive},
      {"noise", &ScannerConfig::noise,
       "Of ranges: AS_GIVEN by the next two, DATA_SHEET (0.01 m) or CONSERVATIVE (1 % of the "
       "range)."},
      {"noise_floor_m", &ScannerConfig::noise_floor_m, "One sigma at no distance.", kNotNegative},
      {"noise_per_m", &ScannerConfig::noise_per_m, "Growth of sigma with range.", kNotNegative},
      {"spot_rad", &ScannerConfig::spot_rad, "Full width of the beam.", kNotNegative},
      {"mixed_share", &ScannerConfig::mixed_share,
       "Of the spots split over an edge: reading between the two surfaces.", kShare},
      {"drop_out", &ScannerConfig::drop_out, "Echo lost at no distance.", kShare},
      {"dark_drop_out", &ScannerConfig::dark_drop_out,
       "Echo from a car lost at maximum range; grows with the square of range.", kShare},
  };
}

FieldTable<GnssConfig> gnss_fields() {
  return {
      {"rate_hz",
       &GnssConfig::rate_hz,
       "Fixes in a second, at most one a scan; 0: no receiver.",
       {0, 100}},
      {"latitude_deg",
       &GnssConfig::latitude_deg,
       "Of the world's origin; its x goes east.",
       {-80, 80}},
      {"longitude_deg", &GnssConfig::longitude_deg, "Of the world's origin.", {-180, 180}},
      {"altitude_m", &GnssConfig::altitude_m, "Of the world's origin.", kMetres},
      {"satellites", &GnssConfig::satellites, "Above the horizon.", {0, 100}},
      {"lowest_rad", &GnssConfig::lowest_rad, "Lower ones are not used.", {0.01, 1.5}},
      {"building_height_m", &GnssConfig::building_height_m,
       "What the sky is hidden by: every wall is so high.", kNotNegative},
      {"antenna_height_m", &GnssConfig::antenna_height_m, "Above the road.", kNotNegative},
      {"range_error_m", &GnssConfig::range_error_m,
       "Of one satellite, one sigma, anew for each fix.", kNotNegative},
      {"wander_m", &GnssConfig::wander_m, "Slow error by the atmosphere, one sigma each way.",
       kNotNegative},
      {"wander_s", &GnssConfig::wander_s, "It is alike over this time.", kPositive},
      {"multipath_m", &GnssConfig::multipath_m,
       "Error by reflections, one sigma each way; times the share of satellites that are hidden.",
       kNotNegative},
      {"multipath_length_m", &GnssConfig::multipath_length_m, "It is alike over this way.",
       kPositive},
  };
}

FieldTable<CompassConfig> compass_fields() {
  return {
      {"rate_hz",
       &CompassConfig::rate_hz,
       "Readings in a second, at most one a scan; 0: no compass.",
       {0, 200}},
      {"noise_rad", &CompassConfig::noise_rad, "Of each reading, one sigma.", kNotNegative},
      {"bias_sigma_rad", &CompassConfig::bias_sigma_rad,
       "By its mounting and the vehicle's iron; drawn once a drive.", kNotNegative},
      {"disturbance_rad", &CompassConfig::disturbance_rad, "By iron around the vehicle, one sigma.",
       kNotNegative},
      {"disturbance_length_m", &CompassConfig::disturbance_length_m, "It is alike over this way.",
       kPositive},
  };
}

}  // namespace

FieldTable<ScenarioConfig> scenario_fields() {
  FieldTable<ScenarioConfig> table = {
      {"description", &ScenarioConfig::description, "One line, for people."},
      {"seed", &ScenarioConfig::seed, "Of everything that is random."},
      {"duration_s", &ScenarioConfig::duration_s, "Of the recording.", kPositive},
      {"start_stamp_s", &ScenarioConfig::start_stamp_s, "Clock at the first scan.", kNotNegative},
      {"warm_up_s", &ScenarioConfig::warm_up_s, "The world moves this long before, unrecorded.",
       kNotNegative},
      {"place", &ScenarioConfig::place, "Which of the three worlds below it is."},
      {"profile", &ScenarioConfig::profile, "Settings that suit the drive."},
      {"log_record", &ScenarioConfig::log_record, "Of a log of the drive."},
      list_of("robot_way", &ScenarioConfig::robot_way, office_corner_fields(),
              "Corners of the robot's way in turn."),
      list_of("terrain", &ScenarioConfig::terrain, height_fields(),
              "Height of the road from west to east; empty: level."),
      list_of("more_scanners", &ScenarioConfig::more_scanners, scanner_fields(),
              "Each with an id of its own."),
      {"sumo_fcd", &ScenarioConfig::sumo_fcd,
       "Traffic of a script from Eclipse SUMO: the file of its --fcd-output."},
      {"sumo_vehicle", &ScenarioConfig::sumo_vehicle,
       "Whom of it to ride; empty: the script's own vehicle."},
      {"ride",
       &ScenarioConfig::ride,
       "Of a script's vehicles with scanners: which one; 0 is the vehicle.",
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
  return with_nested(std::move(table), "scanner", &ScenarioConfig::scanner, scanner_fields());
}

}  // namespace slammot::simulator
