#include "services/collision_warning/warning_level.hpp"

namespace slammot::collision_warning {
namespace {

using flow::WarningLevel;

/// An active level ends below this share of its probability, and beyond this multiple of its time.
constexpr double kEndShare = 0.6;
constexpr double kEndTimeFactor = 1.25;

std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

/// Time for which the conditions of a level must hold: a near contact leaves no time to wait; a far
/// one does, and is more often of a speed that is wrong for some tenths of a second.
double confirmed_after_s(const std::optional<Contact>& contact,
                         const CollisionWarningConfig& config) {
  constexpr double kNearS = 2.2;
  constexpr double kShareIfNear = 0.6;
  constexpr double kTimesIfFar = 2.4;
  const bool is_near = contact && contact->after_s <= kNearS;
  return (is_near ? kShareIfNear : kTimesIfFar) * config.confirm_s;
}

struct Limits {
  double least_probability = 0.0;
  double longest_time_s = 0.0;
};

Limits limits_of(WarningLevel level, const CollisionWarningConfig& config) {
  if (level == WarningLevel::kWarning) return {config.warning_probability, config.warning_time_s};
  return {config.caution_probability, config.horizon_s};
}

bool is_within(const std::optional<Contact>& contact, const Limits& limits) {
  return contact && contact->probability >= limits.least_probability &&
         contact->after_s <= limits.longest_time_s;
}

}  // namespace

WarningLevel LevelOverTime::update(std::int64_t stamp_ns, const std::optional<Contact>& contact,
                                   const CollisionWarningConfig& config) {
  assessed_ns_ = stamp_ns;
  update(caution_, WarningLevel::kCaution, stamp_ns, contact, config);
  update(warning_, WarningLevel::kWarning, stamp_ns, contact, config);
  if (warning_.is_active) return WarningLevel::kWarning;
  return caution_.is_active ? WarningLevel::kCaution : WarningLevel::kNone;
}

void LevelOverTime::update(Condition& condition, WarningLevel level, std::int64_t stamp_ns,
                           const std::optional<Contact>& contact,
                           const CollisionWarningConfig& config) const {
  const Limits begin = limits_of(level, config);
  const Limits end{kEndShare * begin.least_probability, kEndTimeFactor * begin.longest_time_s};
  if (!is_within(contact, begin)) condition.since_ns.reset();
  else if (!condition.since_ns) condition.since_ns = stamp_ns;
  if (is_within(contact, end)) condition.last_held_ns = stamp_ns;
  if (condition.since_ns &&
      stamp_ns - *condition.since_ns >= to_ns(confirmed_after_s(contact, config)))
    condition.is_active = true;
  if (stamp_ns - condition.last_held_ns > to_ns(config.hold_s)) condition.is_active = false;
}

bool LevelOverTime::is_over(std::int64_t stamp_ns, const CollisionWarningConfig& config) const {
  return stamp_ns - assessed_ns_ > to_ns(config.hold_s);
}

}  // namespace slammot::collision_warning
