#include "common/app/health.hpp"

#include <algorithm>
#include <optional>

#include "common/app/status_board.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/reader.hpp"
#include "common/dds/wait_set.hpp"

namespace slammot::app {
namespace {

std::string with_underscores(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

ServiceState state_of(slammot_ServiceState state) {
  return state <= slammot_SERVICE_STATE_STOPPING ? static_cast<ServiceState>(state)
                                                 : ServiceState::kStopping;
}

/// Messages received from the service so far.
class Listener {
 public:
  explicit Listener(HealthQuestion question)
      : question_(std::move(question)),
        service_(with_underscores(question_.service)),
        participant_({question_.domain_id, "slammot-health", question_.dds_config}),
        wait_set_(participant_),
        heartbeats_(participant_, dds::topics::kHeartbeat),
        statuses_(participant_, dds::topics::kStatus) {
    wait_set_.on_data(heartbeats_,
                      [this] { heartbeats_.take_each([this](const auto& beat) { take(beat); }); });
    wait_set_.on_data(
        statuses_, [this] { statuses_.take_each([this](const auto& status) { take(status); }); });
  }

  /// Waits until heartbeat and status are known and the service has started, or until the time-out.
  Health listen() {
    const SteadyTime end = std::chrono::steady_clock::now() + question_.patience;
    while (!is_settled() && std::chrono::steady_clock::now() < end)
      wait_set_.wait(end - std::chrono::steady_clock::now());
    return judge();
  }

 private:
  template <typename Sample>
  bool is_asked_for(const Sample& sample) const {
    return question_.vehicle_id == sample.vehicle_id && service_ == sample.service_name &&
           (question_.instance.empty() || question_.instance == sample.instance_name);
  }
  void take(const slammot_Heartbeat& beat) {
    if (is_asked_for(beat)) state_ = state_of(beat.state);
  }
  void take(const slammot_ServiceStatus& status) {
    const bool has_started = status.state != slammot_SERVICE_STATE_STARTING;
    if (has_started && is_asked_for(status)) explanation_ = status.explanation;
  }
  bool is_settled() const { return state_ && *state_ != ServiceState::kStarting && explanation_; }
  Health judge() const {
    const auto patience_s =
        std::chrono::duration_cast<std::chrono::seconds>(question_.patience).count();
    if (!state_)
      return {false, service_ + ": no heartbeat within " + std::to_string(patience_s) + " s"};
    const bool is_at_work = *state_ == ServiceState::kRunning || *state_ == ServiceState::kDegraded;
    std::string text = service_ + ": " + std::string(to_string(*state_));
    if (*state_ == ServiceState::kDegraded && explanation_ && !explanation_->empty())
      text += ", " + *explanation_;
    return {is_at_work, text};
  }

  HealthQuestion question_;
  std::string service_;
  dds::Participant participant_;
  dds::WaitSet wait_set_;
  dds::Reader<slammot_Heartbeat> heartbeats_;
  dds::Reader<slammot_ServiceStatus> statuses_;
  std::optional<ServiceState> state_;
  std::optional<std::string> explanation_;
};

}  // namespace

Health check_health(const HealthQuestion& question) { return Listener(question).listen(); }

}  // namespace slammot::app
