#include "services/collision_warning/collision_warning_fields.hpp"

namespace slammot::collision_warning {

const config::FieldTable<CollisionWarningConfig>& collision_warning_fields() {
  using C = CollisionWarningConfig;
  using config::kPositive;
  using config::kShare;
  using config::Range;
  static const config::FieldTable<C> table = config::in_group<C>(
      config::Group::warning,
      {
          {"vehicle_length_m",
           &C::vehicle_length_m,
           "Length of the vehicle's footprint.",
           kPositive,
           {"Contacts of its ends are missed.", "It warns of what passes clear of its ends."}},
          {"vehicle_width_m",
           &C::vehicle_width_m,
           "Width of the vehicle's footprint, mirrors excluded.",
           kPositive,
           {"Contacts of its corners are missed.", "It warns in narrow places."}},
          {"vehicle_centre_ahead_m",
           &C::vehicle_centre_ahead_m,
           "Centre of the footprint, forward of base.",
           Range{-100.0, 100.0},
           {"Warnings are late.", "Warnings are early."}},
          {"horizon_s",
           &C::horizon_s,
           "Contacts later than this are not predicted.",
           Range{0.5, 10.0},
           {"Cautions are late.", "Cautions are of what nobody can know, and cost more time."}},
          {"warning_time_s",
           &C::warning_time_s,
           "A warning is of a contact whose median time is at most so far ahead.",
           kPositive,
           {"Warnings are late.", "Road users who still have time to yield are warned of."}},
          {"warning_probability",
           &C::warning_probability,
           "Least probability of contact of a warning.",
           kShare,
           {"More false warnings.", "More warnings that are late or missing."}},
      });
  return table;
}

}  // namespace slammot::collision_warning
