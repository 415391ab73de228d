#include "services/slammot/service_processes.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "common/dds/config.hpp"

extern char** environ;

namespace slammot {
namespace {

using namespace std::chrono_literals;

constexpr auto kStartupTime = 2s;  ///< A service that exits with a fault sooner has failed to
                                   ///< start.
constexpr int kMaxFailedStarts = 3;
constexpr auto kPatienceForEnd = 2s;

std::vector<char*> pointers_to(const std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  for (const std::string& string : strings) pointers.push_back(const_cast<char*>(string.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// Runs in the child between fork and exec: system calls only.
[[noreturn]] void execute(char* const* arguments, char* const* environment, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent died before prctl()
  setpgid(0, 0);  // Ctrl-C reaches only the parent, which then ends its children in order.
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execve(arguments[0], arguments, environment);
  _exit(127);
}

}  // namespace

ServiceProcesses::ServiceProcesses(std::vector<ServiceProcess> services,
                                   std::filesystem::path log_folder,
                                   std::map<std::string, std::string> environment)
    : log_folder_(std::move(log_folder)) {
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    if (!environment.contains(text.substr(0, text.find('=')))) environment_.push_back(text);
  }
  for (const auto& [name, value] : environment) environment_.push_back(name + "=" + value);
  for (ServiceProcess& service : services) {
    if (access(service.arguments.front().c_str(), X_OK) != 0) {
      throw std::runtime_error("cannot start " + service.arguments.front() + ": " +
                               std::strerror(errno));
    }
    restarts_[service.name] = 0;
    all_.push_back({std::move(service), 0, std::nullopt, {}, 0, {}});
  }
  for (Running& running : all_) start(running);
}

void ServiceProcesses::start(Running& running) {
  const std::filesystem::path log_file = log_folder_ / (running.service.name + ".log");
  const int log = open(log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const std::vector<char*> arguments = pointers_to(running.service.arguments);
  const std::vector<char*> environment = pointers_to(environment_);
  const pid_t parent = getpid();
  running.started = std::chrono::steady_clock::now();
  running.process = fork();
  if (running.process == 0) execute(arguments.data(), environment.data(), log, parent);
  if (log >= 0) close(log);
  if (running.process < 0) {
    running.process = 0;
    throw std::runtime_error("cannot start " + running.service.name + ": " + std::strerror(errno));
  }
}

std::optional<std::string> ServiceProcesses::restart_dead() {
  for (Running& running : all_) {
    int status = 0;
    if (running.process == 0 || waitpid(running.process, &status, WNOHANG) != running.process)
      continue;
    running.process = 0;
    const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (running.service.may_end && (exit_code == 0 || exit_code == 3)) {
      running.exit_code = exit_code;
      continue;
    }
    if (is_broken(running, exit_code)) {
      return running.service.name + " does not keep running (" +
             last_log_line(running.service.name) + ")";
    }
    ++restarts_[running.service.name];
    start(running);
  }
  return std::nullopt;
}

/// One that has just ended.
bool ServiceProcesses::is_broken(Running& running, int exit_code) const {
  const auto now = std::chrono::steady_clock::now();
  const bool has_failed_start = exit_code > 0 && now - running.started < kStartupTime;
  running.failed_starts = has_failed_start ? running.failed_starts + 1 : 0;
  while (!running.restarts.empty() && now - running.restarts.front() > 1min)
    running.restarts.pop_front();
  running.restarts.push_back(now);
  return running.failed_starts >= kMaxFailedStarts || running.restarts.size() > kMaxRestarts;
}

std::optional<int> ServiceProcesses::ended(const std::string& name) const {
  for (const Running& running : all_) {
    if (running.service.name == name) return running.exit_code;
  }
  return std::nullopt;
}

std::optional<std::string> ServiceProcesses::find_end(const std::string& name) {
  for (Running& running : all_) {
    if (running.service.name != name) continue;
    if (running.process != 0 && waitpid(running.process, nullptr, WNOHANG) == running.process)
      running.process = 0;
    if (running.process == 0) return name + " has ended (" + last_log_line(name) + ")";
  }
  return std::nullopt;
}

std::string ServiceProcesses::last_log_line(const std::string& name) const {
  std::ifstream file(log_folder_ / (name + ".log"));
  std::string last = "no output";
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

void ServiceProcesses::end(const std::function<bool(const Running&)>& is_selected) {
  const auto has_ended = [&](Running& running) {
    if (!is_selected(running)) return true;
    if (running.process != 0 && waitpid(running.process, nullptr, WNOHANG) == running.process)
      running.process = 0;
    return running.process == 0;
  };
  for (const Running& running : all_) {
    if (is_selected(running) && running.process != 0) kill(running.process, SIGTERM);
  }
  const auto give_up_at = std::chrono::steady_clock::now() + kPatienceForEnd;
  while (!std::ranges::all_of(all_, has_ended) && std::chrono::steady_clock::now() < give_up_at)
    std::this_thread::sleep_for(10ms);
  for (Running& running : all_) {
    if (has_ended(running)) continue;
    kill(running.process, SIGKILL);
    waitpid(running.process, nullptr, 0);
    running.process = 0;
  }
}

void ServiceProcesses::end(const std::string& name) {
  end([&](const Running& running) { return running.service.name == name; });
}

ServiceProcesses::~ServiceProcesses() {
  end([](const Running&) { return true; });
}

std::map<std::string, std::string> environment_of_bus(const std::string& name) {
  return {{"CYCLONEDDS_URI", dds::loopback_config(name)}, {"SLAMMOT_BUS", ""}};
}

TemporaryFolder::TemporaryFolder(const std::string& prefix) {
  std::string name = (std::filesystem::temp_directory_path() / (prefix + "XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("cannot create a folder like " + name + ": " + std::strerror(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path folder_of_this_program() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace slammot
