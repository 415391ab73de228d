#include "services/localization/localization_service_session.hpp"

#include "common/app/log.hpp"

namespace slammot::localization {

std::optional<StampedSession> SessionFile::look_back() {
  return std::exchange(has_looked_back_, true) ? std::nullopt : read();
}

std::optional<StampedSession> SessionFile::read() const {
  const auto saved = file_.read();
  if (!saved) return std::nullopt;
  auto session = session_of(saved->bytes);
  if (!session) {
    app::log_warn("the checkpoint is of another version: it is not used");
    return std::nullopt;
  }
  return StampedSession{saved->stamp_ns, std::move(*session)};
}

bool SessionFile::is_due(std::int64_t stamp_ns, std::int64_t now_ns) const {
  constexpr std::int64_t kPeriodNs = 1'000'000'000;
  constexpr std::int64_t kShortestPauseNs = 250'000'000;
  if (!saved_ns_) return true;
  return stamp_ns - *saved_ns_ >= kPeriodNs && now_ns - last_time_ns_ >= kShortestPauseNs;
}

void SessionFile::save(std::int64_t stamp_ns, std::int64_t now_ns, SavedSession session,
                       const Localizer& localizer) {
  LocalMap::Snapshot memory = last_ ? std::move(last_->localizer.map) : LocalMap::Snapshot();
  last_ = std::make_shared<Unwritten>(
      Unwritten{std::move(session), *localizer.snapshot(std::move(memory))});
  file_.save(stamp_ns, [unwritten = last_] {
    unwritten->session.localizer = to_bytes(unwritten->localizer);
    return to_bytes(std::exchange(unwritten->session, {}));
  });
  saved_ns_ = stamp_ns;
  last_time_ns_ = now_ns;
}

void SessionFile::save_last(std::int64_t stamp_ns, SavedSession session,
                            const Localizer& localizer) {
  last_.reset();  // its memory may be in use
  session.has_ended = true;
  save(stamp_ns, last_time_ns_, std::move(session), localizer);
}

}  // namespace slammot::localization
