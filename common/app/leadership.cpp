#include "common/app/leadership.hpp"

#include <algorithm>

namespace slammot::app {

void Leadership::heard(const wire::Heartbeat& beat, SteadyTime now) {
  Identity identity{beat.started_ns, beat.process_number, beat.name.instance};
  if (identity == self_) return;
  std::erase_if(others_, [&](const Other& other) {
    return other.identity == identity || now - other.last > 100 * kLease;
  });
  highest_term_ = std::max(highest_term_, beat.term);
  others_.push_back({std::move(identity), beat.term, beat.stands_by,
                     beat.state == wire::ServiceState::kStopping, now});
}

bool Leadership::prevails(const Other& other) const {
  return other.term != term_ ? other.term > term_ : other.identity < self_;
}

Leadership::Role Leadership::role(SteadyTime now) const {
  const auto any = [&](const auto& is_wanted) {
    return std::ranges::any_of(
        others_, [&](const Other& other) { return is_alive(other, now) && is_wanted(other); });
  };
  if (term_ > 0) {
    const bool yields =
        any([this](const Other& other) { return !other.stands_by && prevails(other); });
    return yields ? Role::kSteppedDown : Role::kLeads;
  }
  if (any([](const Other& other) { return !other.stands_by; })) return Role::kStandsBy;
  if (now - since_ < kLease) return Role::kUndecided;
  const bool is_first =
      !any([this](const Other& other) { return other.stands_by && other.identity < self_; });
  return is_first ? Role::kMayLead : Role::kStandsBy;
}

std::uint32_t Leadership::lead() { return term_ = highest_term_ + 1; }

std::optional<Leadership::Identity> Leadership::leader() const {
  const auto leading =
      std::ranges::find_if(others_, [](const Other& other) { return !other.stands_by; });
  return leading == others_.end() ? std::nullopt : std::optional(leading->identity);
}

}  // namespace slammot::app
