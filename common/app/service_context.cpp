#include "common/app/service_context.hpp"

#include <algorithm>
#include <utility>

#include "common/app/log.hpp"
#include "common/app/scan_latency.hpp"
#include "common/app/supervisor.hpp"
#include "common/app/system_clock.hpp"

namespace slammot::app {
namespace {

/// A quarter of the time after which a leader that is not heard is replaced.
constexpr std::chrono::milliseconds kRoleHeartbeatPeriod{50};

slammot_Reply reply_to(const slammot_Command& command, const CommandResult& result) {
  return wire::encode(wire::Reply{.vehicle_id = command.vehicle_id,
                                  .requester = command.requester,
                                  .request_number = command.request_number,
                                  .service = command.service_name,
                                  .outcome = result.outcome,
                                  .explanation = result.explanation});
}

/// The text without digits, so that a lasting state with changing numbers is logged once.
std::string without_digits(std::string text) {
  std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
  return text;
}

/// "laser_scan" of "slammot/laser_scan".
std::string short_name(const std::string& topic) { return topic.substr(topic.find('/') + 1); }

}  // namespace

bool ForeignSamples::accepts(ServiceContext& context, const dds::SampleInfo& info) {
  constexpr std::chrono::seconds kToldFor{5};
  const SteadyTime now = std::chrono::steady_clock::now();
  const auto is_gone = [this](std::uint64_t writer) { return !reader_.is_matched(writer); };
  const bool is_accepted = owners_.accepts({info.key_handle, info.writer_handle}, now, is_gone);
  if (!is_accepted) {
    const std::string words = "drops " + topic_ + " of a second writer";
    context.warn("foreign_" + short_name(topic_), words);
    context.status().set_trouble("foreign " + topic_, words);
    told_ = now;
  } else if (told_ && now - *told_ > kToldFor) {
    told_.reset();
    context.status().clear_trouble("foreign " + topic_);
  }
  return is_accepted;
}

ServiceContext::ServiceContext(const std::string& service, const ServiceOptions& options)
    : options_(options),
      service_(service),
      participant_({options.domain_id, "slammot-" + service, options.dds_config}),
      wait_set_(participant_),
      publisher_(participant_, {options.vehicle_id, service, options.instance}) {
  publisher_.beat(ServiceState::kStarting);
  publisher_.report(board_, ServiceState::kStarting);
  auto& replies = write(dds::topics::kReply);
  const auto commands =
      std::make_shared<dds::Reader<slammot_Command>>(participant_, dds::topics::kCommand);
  wait_set_.on_data(*commands, [this, commands = commands.get(), &replies] {
    commands->take_each([&](const slammot_Command& command) {
      if (vehicle_id() != command.vehicle_id || service_ != command.service_name) return;
      const CommandResult result =
          desk_.answer({command.requester, command.request_number, command.verb, command.argument});
      replies.write(reply_to(command, result));
    });
  });
  keep(commands);
  every(StatusPublisher::kHeartbeatPeriod, [this] { beat(); });
  every(StatusPublisher::kStatusPeriod, [this] { report(); });
}

void ServiceContext::every(std::chrono::nanoseconds period, std::function<void()> work) {
  timers_.push_back({std::chrono::steady_clock::now() + period, period, std::move(work)});
}

void ServiceContext::after(std::chrono::nanoseconds delay, std::function<void()> work) {
  timers_.push_back({std::chrono::steady_clock::now() + delay, std::nullopt, std::move(work)});
}

void ServiceContext::warn(const std::string& counter, std::string_view line) {
  ++board_.counter(counter);
  const std::string text = rate_limit_.pass(counter, line, std::chrono::steady_clock::now());
  if (!text.empty()) log_warn("{}", text);
}

void ServiceContext::note_since_scan(const std::string& stage, std::int64_t scan_published_ns) {
  add_since_scan(board_.latency(stage), scan_published_ns, system_clock_ns());
}

void ServiceContext::stop(int exit_code) {
  exit_code_ = exit_code;
  stop();
}

void ServiceContext::request_stop() {
  if (stops_between_scans_) stop_request_.make(std::chrono::steady_clock::now());
  else stop();
}

bool ServiceContext::may_stop_now() {
  if (!stop_request_.is_made()) return false;
  stop();
  return true;
}

void ServiceContext::warn_of_cut_samples(const dds::ReaderBase& reader, std::uint64_t& known) {
  for (; known < reader.cut(); ++known)
    warn("cut_samples", std::string(reader.topic().name) + ": dropped a sample that ends early");
}

void ServiceContext::count_missed(const InputWatch& input, std::uint32_t samples) {
  if (samples == 0) return;
  const std::string counter = "missed_" + short_name(input.topic_name());
  warn(counter, "missed " + std::to_string(samples) + " of " + input.topic_name());
  board_.counter(counter) += samples - 1;  // warn() counted one
}

void ServiceContext::refuse_unless_publisher(const dds::TopicInfo& topic) const {
  if (dds::may_publish(service_, topic)) return;
  throw std::logic_error(service_ + " is no publisher of " + std::string(topic.name) +
                         " in common/dds/topic_table.hpp");
}

std::chrono::nanoseconds ServiceContext::until_next_timer() const {
  const auto next = std::ranges::min_element(timers_, {}, &Timer::due);
  return std::max(next->due - std::chrono::steady_clock::now(), std::chrono::nanoseconds(0));
}

void ServiceContext::run_due_timers() {
  const SteadyTime now = std::chrono::steady_clock::now();
  std::vector<std::function<void()>> due;  // collected first: a callback may add timers
  for (Timer& timer : timers_) {
    if (timer.due > now) continue;
    due.push_back(timer.work);
    if (timer.period) timer.due = std::max(timer.due + *timer.period, now);
  }
  std::erase_if(timers_, [now](const Timer& timer) { return !timer.period && timer.due <= now; });
  for (const auto& work : due) work();
}

void ServiceContext::report() {
  const SteadyTime now = std::chrono::steady_clock::now();
  report_changes(board_.explanation(now));
  report_mismatches();
  report_as(board_.state(now));
}

void ServiceContext::report_as(ServiceState state) {
  for (const auto& work : before_report_) work();
  publisher_.report(board_, state);
  tell_supervisor(state, board_.explanation(std::chrono::steady_clock::now()));
}

void ServiceContext::report_changes(const std::string& explanation) {
  if (without_digits(explanation) == without_digits(last_explanation_)) return;
  if (explanation.empty()) {
    log_info("works again ({})", last_explanation_);
  } else {
    log_warn("{}", explanation);
  }
  last_explanation_ = explanation;
}

void ServiceContext::report_mismatches() {
  std::uint32_t total = 0;
  std::string last;
  for (const auto& find_mismatch : mismatches_) {
    const auto mismatch = find_mismatch();
    if (!mismatch) continue;
    total += mismatch->total;
    last = mismatch->text();
  }
  if (total > mismatches_reported_) log_warn("{}", last);
  mismatches_reported_ = total;
  board_.counter("incompatible_endpoints") = total;
}

void ServiceContext::run_for(std::chrono::nanoseconds duration) {
  const SteadyTime end = std::chrono::steady_clock::now() + duration;
  for (SteadyTime now = std::chrono::steady_clock::now(); now < end;
       now = std::chrono::steady_clock::now()) {
    const auto wait = std::min<std::chrono::nanoseconds>(until_next_timer(), end - now);
    if (wait_set_.wait(wait) == dds::WaitSet::Wake::kStopped) return;
    run_due_timers();
  }
}

void ServiceContext::beat() {
  publisher_.beat(board_.state(std::chrono::steady_clock::now()));
  tell_supervisor_alive();
}

void ServiceContext::set_role(const StatusPublisher::Role& role) {
  publisher_.set_role(role);
  beat();
  if (!std::exchange(has_role_, true)) every(kRoleHeartbeatPeriod, [this] { beat(); });
}

bool ServiceContext::run_until(const std::function<bool()>& condition) {
  constexpr std::chrono::nanoseconds kTurn = std::chrono::milliseconds(5);
  while (!condition()) {
    if (wait_set_.wait(std::min(until_next_timer(), kTurn)) == dds::WaitSet::Wake::kStopped) {
      report_as(ServiceState::kStopping);
      say_goodbye();
      return false;
    }
    run_due_timers();
  }
  return true;
}

void ServiceContext::run(const std::function<void()>& end) {
  beat();
  report();
  while (wait_set_.wait(until_next_timer()) != dds::WaitSet::Wake::kStopped) {
    run_due_timers();
    if (stop_request_.is_overdue(std::chrono::steady_clock::now())) stop();
  }
  report_as(ServiceState::kStopping);
  end();
  say_goodbye();
}

/// After the last work of the service, which may be gone.
void ServiceContext::say_goodbye() {
  for (const auto& hand_over : hand_over_) hand_over();
  publisher_.beat(ServiceState::kStopping);
  publisher_.wait_until_heard(std::chrono::milliseconds(500));
}

}  // namespace slammot::app
