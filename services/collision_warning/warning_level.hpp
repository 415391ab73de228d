#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/flow/collision_warnings.hpp"
#include "services/collision_warning/collision_warning_config.hpp"
#include "services/collision_warning/encounter.hpp"

namespace slammot::collision_warning {

/// Level of one object over time, with hysteresis: a level begins once its conditions held for
/// `confirm_s`, and ends once weaker conditions did not hold for `hold_s`.
class LevelOverTime {
 public:
  flow::WarningLevel update(std::int64_t stamp_ns, const std::optional<Contact>& contact,
                            const CollisionWarningConfig& config);

  /// True if the object has not been assessed for longer than a level is held.
  bool is_over(std::int64_t stamp_ns, const CollisionWarningConfig& config) const;

 private:
  struct Condition {
    bool is_active = false;
    std::optional<std::int64_t> since_ns{};  ///< It has held since then; none if it does not hold.
    std::int64_t last_held_ns = 0;           ///< Or its weaker form.
  };

  void update(Condition& condition, flow::WarningLevel level, std::int64_t stamp_ns,
              const std::optional<Contact>& contact, const CollisionWarningConfig& config) const;

  Condition caution_;
  Condition warning_;
  std::int64_t assessed_ns_ = 0;
};

}  // namespace slammot::collision_warning
