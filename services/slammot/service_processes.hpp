#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace slammot {

/// A process to be kept running.
struct ServiceProcess {
  std::string name;                    ///< For messages.
  std::vector<std::string> arguments;  ///< The program's path first.
  bool may_end = false;                ///< Exit codes 0 and 3 (truncated log) are not failures.
};

/// Child processes that are restarted when they die. They never outlive this process: the
/// destructor ends them, and the kernel kills them if this process is killed. Their output goes to
/// NAME.log in the log folder.
class ServiceProcesses {
 public:
  /// Of one service within a minute; with more it is considered broken.
  static constexpr std::size_t kMaxRestarts = 20;

  /// Throws std::runtime_error with one line if a program cannot be started.
  ServiceProcesses(std::vector<ServiceProcess> services, std::filesystem::path log_folder,
                   std::map<std::string, std::string> environment);
  ~ServiceProcesses();  ///< SIGTERM to all; SIGKILL after 2 s.
  ServiceProcesses(const ServiceProcesses&) = delete;
  ServiceProcesses& operator=(const ServiceProcesses&) = delete;

  /// Restarts dead processes. Returns a message, with the last line of the service's log, if a
  /// service keeps failing.
  std::optional<std::string> restart_dead();

  /// Ends a service for good: SIGTERM, SIGKILL after 2 s.
  void end(const std::string& name);

  /// Exit code of a service that may end and has ended.
  std::optional<int> ended(const std::string& name) const;

  /// A message, with the last line of its log, if the service has ended; it is not restarted.
  std::optional<std::string> find_end(const std::string& name);

  const std::map<std::string, std::uint64_t>& restarts() const { return restarts_; }

 private:
  struct Running {
    ServiceProcess service;
    pid_t process = 0;  ///< 0: has ended.
    std::optional<int> exit_code;
    std::chrono::steady_clock::time_point started;
    int failed_starts = 0;
    std::deque<std::chrono::steady_clock::time_point> restarts;  ///< In the last minute.
  };

  void start(Running& running);
  bool is_broken(Running& running, int exit_code) const;
  void end(const std::function<bool(const Running&)>& is_selected);
  std::string last_log_line(const std::string& name) const;

  std::vector<Running> all_;
  std::filesystem::path log_folder_;
  std::vector<std::string> environment_;
  std::map<std::string, std::uint64_t> restarts_;
};

/// Environment of processes on a closed bus of this name on this machine.
std::map<std::string, std::string> environment_of_bus(const std::string& name);

/// A folder under the system's temporary folder, removed with its content by the destructor.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& prefix);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Folder of this executable and of the services.
std::filesystem::path folder_of_this_program();

}  // namespace slammot
