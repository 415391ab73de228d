#include "common/app/readiness.hpp"

#include "common/app/service_context.hpp"
#include "common/wire/text.hpp"

namespace slammot::app {

bool take(const slammot_Heartbeat& beat, Readiness& readiness) {
  if (beat.stands_by) return false;
  readiness.heard(
      std::string(wire::text(beat.service_name)),
      beat.state == slammot_SERVICE_STATE_RUNNING || beat.state == slammot_SERVICE_STATE_DEGRADED);
  return beat.state == slammot_SERVICE_STATE_STARTING;
}

bool may_begin(ServiceContext& context, Readiness& readiness, std::string_view topic, bool is_read,
               bool is_patient) {
  std::string missing = readiness.missing();
  if (!is_read) missing = "a reader of " + std::string(topic) + ", " + missing;
  if (!missing.empty() && is_patient) {
    context.status().set_trouble("services", "waiting for " + missing);
    return false;
  }
  if (missing.empty() && !readiness.have_met(std::chrono::steady_clock::now())) return false;
  if (!missing.empty()) context.warn("begun_without_all_services", "begins without " + missing);
  context.status().clear_trouble("services");
  return true;
}

}  // namespace slammot::app
