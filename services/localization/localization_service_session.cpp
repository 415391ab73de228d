#include "services/localization/localization_service_session.hpp"

#include <spdlog/spdlog.h>

namespace slammot::localization {

std::optional<StampedSession> SessionFile::look_back() {
  return std::exchange(has_looked_back_, true) ? std::nullopt : read();
}

std::optional<StampedSession> SessionFile::read() const {
  const auto saved = file_.read();
  if (!saved) return std::nullopt;
  auto session = session_of(saved->bytes);
  if (!session) {
    spdlog::warn("the checkpoint is of another version: it is not used");
    return std::nullopt;
  }
  return StampedSession{saved->stamp_ns, std::move(*session)};
}

bool SessionFile::is_due(std::int64_t stamp_ns) const {
  constexpr std::int64_t kPeriodNs = 1'000'000'000;
  return (!saved_ns_ || stamp_ns - *saved_ns_ >= kPeriodNs) && !file_.is_busy();
}

void SessionFile::save(std::int64_t stamp_ns, const SavedSession& session) {
  file_.save({stamp_ns, to_bytes(session)});
  saved_ns_ = stamp_ns;
}

}  // namespace slammot::localization
