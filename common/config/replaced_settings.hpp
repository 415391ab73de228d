#pragma once

#include <array>
#include <string_view>

namespace slammot::config {

/// A setting of earlier versions whose effect another one has now.
struct ReplacedSetting {
  std::string_view message;  ///< Of slammot.proto, that had it.
  std::string_view name;
  std::string_view replacement;  ///< As in a file of settings.
};

inline constexpr std::array kReplacedSettings{
    ReplacedSetting{"Localization", "longest_step_s", "localization { vehicle: robot }"},
    ReplacedSetting{"Localization", "pose_errors", "localization { pose_error_model: building }"},
    ReplacedSetting{"Localization", "variance_by_scans_alone",
                    "localization { pose_error_model: building }"},
    ReplacedSetting{"LocalMap", "lasting", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "position_noise_m", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "position_noise_per_m", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "sideways_noise_per_m", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "heading_noise_rad", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "heading_noise_per_m", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "heading_noise_per_rad", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "askew_prior_rad", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "pivot_prior_m", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "pivot_walk_m", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "speed_prior_mps", "localization { vehicle: robot }"},
    ReplacedSetting{"MotionModel", "scale_prior", "localization { belief { way_at_start: ... } }"},
    ReplacedSetting{"PointToLine", "proven_after_m", "localization { vehicle: robot }"},
    ReplacedSetting{"PointToLine", "information_share", "localization { vehicle: robot }"},
    ReplacedSetting{"LoopClosing", "place", "loop_closing { surroundings: building }"},
    ReplacedSetting{"LoopClosing", "revisit", "loop_closing { surroundings: building }"},
};

}  // namespace slammot::config
