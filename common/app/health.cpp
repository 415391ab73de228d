#include "common/app/health.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

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

/// Messages received from one process so far.
struct Heard {
  wire::ServiceName name;
  std::uint32_t process_number = 0;
  std::optional<ServiceState> state;      ///< By its heartbeat.
  std::optional<ServiceState> explained;  ///< The state that its status explains.
  std::string explanation;
  bool stands_by = false;

  /// The status may still be of the state before. A standby starts when it takes over.
  bool is_settled() const {
    if (!state || !explained) return false;
    return stands_by || (*state != ServiceState::kStarting && *state == *explained);
  }
};

Verdict verdict_of(const Heard& heard) {
  if (heard.stands_by || heard.state == ServiceState::kRunning) return Verdict::kGood;
  return heard.state == ServiceState::kDegraded ? Verdict::kDegraded : Verdict::kDown;
}

Health health_of(const Heard& heard) {
  std::string text(to_string(heard.state.value_or(ServiceState::kStarting)));
  const std::string& reason = heard.explanation;
  if (heard.stands_by) text = reason.empty() ? "stands by" : reason;
  else if (!reason.empty()) text += ": " + reason;
  return {heard.name, heard.process_number, heard.stands_by, verdict_of(heard), text};
}

class Listener {
 public:
  explicit Listener(const HealthQuestion& question)
      : question_(question),
        participant_({question.domain_id, "slammot-health", question.dds_config}),
        wait_set_(participant_),
        heartbeats_(participant_, dds::topics::kHeartbeat),
        statuses_(participant_, dds::topics::kStatus) {
    for (std::string& service : question_.services) service = with_underscores(service);
    wait_set_.on_data(heartbeats_,
                      [this] { heartbeats_.take_each([this](const auto& beat) { take(beat); }); });
    wait_set_.on_data(
        statuses_, [this] { statuses_.take_each([this](const auto& status) { take(status); }); });
  }

  std::vector<Health> listen() {
    const SteadyTime end = std::chrono::steady_clock::now() + question_.patience;
    while (!is_settled() && std::chrono::steady_clock::now() < end)
      wait_set_.wait(end - std::chrono::steady_clock::now());
    return judge();
  }

 private:
  using Key = std::tuple<std::string, std::string, std::string, std::uint32_t>;

  Heard* heard_of(const wire::ServiceName& name, std::uint32_t process_number) {
    const bool is_asked_for =
        (question_.vehicle_id.empty() || question_.vehicle_id == name.vehicle_id) &&
        (question_.instance.empty() || question_.instance == name.instance) &&
        (question_.services.empty() ||
         std::ranges::find(question_.services, name.service) != question_.services.end());
    if (!is_asked_for) return nullptr;
    Heard& heard = heard_[{name.vehicle_id, name.service, name.instance, process_number}];
    heard.name = name;
    heard.process_number = process_number;
    return &heard;
  }
  void take(const slammot_Heartbeat& sample) {
    const auto beat = wire::decode(sample);
    Heard* const heard = beat ? heard_of(beat->name, beat->process_number) : nullptr;
    if (heard == nullptr) return;
    heard->state = beat->state;
    heard->stands_by = beat->stands_by;
  }
  /// The reason of a start is told meanwhile; the last one counts.
  void take(const slammot_ServiceStatus& sample) {
    const auto status = wire::decode(sample);
    Heard* const heard = status ? heard_of(status->name, status->process_number) : nullptr;
    if (heard == nullptr) return;
    heard->explained = status->state;
    heard->explanation = status->explanation;
  }
  bool is_settled() const {
    return !question_.services.empty() &&
           std::ranges::all_of(question_.services, [this](const std::string& service) {
             return std::ranges::any_of(heard_, [&](const auto& one) {
               return one.second.name.service == service && one.second.is_settled() &&
                      !one.second.stands_by;
             });
           });
  }
  std::vector<Health> judge() const {
    std::vector<Health> healths;
    for (const auto& [key, heard] : heard_) {
      if (heard.state) healths.push_back(health_of(heard));
    }
    for (const std::string& service : question_.services) {
      const bool is_heard = std::ranges::any_of(
          healths, [&](const Health& health) { return health.name.service == service; });
      if (!is_heard) healths.push_back(silent(service));
    }
    return healths;
  }
  Health silent(const std::string& service) const {
    const auto patience_s =
        std::chrono::duration_cast<std::chrono::seconds>(question_.patience).count();
    return {{question_.vehicle_id, service, question_.instance},
            0,
            false,
            Verdict::kDown,
            "no heartbeat within " + std::to_string(patience_s) + " s"};
  }

  HealthQuestion question_;
  dds::Participant participant_;
  dds::WaitSet wait_set_;
  dds::Reader<slammot_Heartbeat> heartbeats_;
  dds::Reader<slammot_ServiceStatus> statuses_;
  std::map<Key, Heard> heard_;
};

}  // namespace

std::vector<Health> check_health(const HealthQuestion& question) {
  return Listener(question).listen();
}

Verdict verdict_of(const std::vector<Health>& healths) {
  Verdict worst = Verdict::kGood;
  bool has_any = false;
  for (const Health& health : healths) {
    const bool has_leader = std::ranges::any_of(healths, [&](const Health& other) {
      return other.name.service == health.name.service &&
             other.name.vehicle_id == health.name.vehicle_id && !other.stands_by;
    });
    worst = std::max(worst, has_leader ? health.verdict : Verdict::kDown);
    has_any = true;
  }
  return has_any ? worst : Verdict::kDown;
}

}  // namespace slammot::app
