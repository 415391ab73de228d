#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/sensing/spatial_mounting.hpp"

namespace slammot::files {

/// A scanner that is said to scan a vertical profile, with its mounting.
struct VerticalScanner {
  std::string text;  ///< As parse_vertical_scanner() takes it.
  std::string name;
  sensing::SpatialMounting mounting;
};

/// Parses NAME=AHEAD,LEFT,UP,ROLL,PITCH,HEADING [m, degrees]. Fails with one line that names the
/// form, also for a mounting whose beams are not steep.
Result<VerticalScanner> parse_vertical_scanner(const std::string& text);

/// What may be asked for where a log leaves a choice.
struct TopicOptions {
  std::vector<std::string> scanners;  ///< Names of those to be used, as they are said when the log
                                      ///< is opened; empty: all whose mounting is known.
  std::string scan_topic;  ///< Of the main scanner, or its message's name in CARMEN; empty: by what
                           ///< they hold.
  std::string odometry_topic;  ///< nav_msgs/Odometry, or the topic of the transforms; "none" for no
                               ///< odometry.
  std::vector<VerticalScanner> vertical;  ///< Replaces what the log says of their mounting.
  /// Heights above the base between which points of clouds count [m]; without them a slice around
  /// the height of the sensor.
  std::optional<double> cloud_from_m;
  std::optional<double> cloud_to_m;
};

/// A topic that could be the scanner, or the odometry.
struct TopicCandidate {
  std::string topic;
  std::string type;   ///< "sensor_msgs/LaserScan"
  std::string frame;  ///< Of the scanner; of odometry the frame of the base.
  std::uint64_t messages = 0;
  double rate_hz = 0.0;   ///< By the time of recording; 0 where that does not say.
  std::size_t beams = 0;  ///< Of most scans.
  double field_of_view_rad = 0.0;
  bool is_chosen = false;
  std::string note;  ///< Why it is doubtful, or what is special: "upside down", "never moves".
};

/// Which topics were chosen from which.
struct TopicChoice {
  std::vector<TopicCandidate> scanners;  ///< The best first. Several may be chosen, each another
                                         ///< scanner.
  std::vector<TopicCandidate> odometry;
  std::vector<std::string> doubts;  ///< Messages that were left out or are contradictory.
  std::vector<std::string> notes;   ///< What else to know: frames that are not tied to each other.
};

/// Lines for the terminal: what was chosen, the other candidates, and the option that selects.
/// Empty without candidates.
std::string describe(const TopicChoice& choice);

}  // namespace slammot::files
