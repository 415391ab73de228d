#pragma once

namespace slammot::collision_warning {

struct CollisionWarningConfig {
  double vehicle_length_m = 5.0;        ///< Footprint of the vehicle.
  double vehicle_width_m = 2.0;         ///< Footprint of the vehicle, mirrors excluded.
  double vehicle_centre_ahead_m = 0.0;  ///< Centre of the footprint, forward of base.
  double horizon_s = 4.0;               ///< Contacts later than this are not predicted.
  double warning_time_s = 3.0;          ///< A warning is of a contact within this time.
  double warning_probability = 0.5;     ///< Least probability of contact of a warning.
  double caution_probability = 0.3;     ///< Least probability of contact of a caution.
  double confirm_s = 0.15;  ///< A level begins after its conditions held for about so long,
  double hold_s = 0.5;      ///< and ends after they did not hold for so long.
  double acceleration_sigma_mps2 = 0.5;  ///< What the driver may do against the prediction; one
                                         ///< sigma along the path,
  double yaw_rate_sigma_radps = 0.03;    ///< and of the turn; also of other drivers.
  double pedestrian_acceleration_sigma_mps2 = 0.3;  ///< The same of a pedestrian, each axis.
};

}  // namespace slammot::collision_warning
