#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace slammot {

/// One process to be started and kept running.
struct ServiceProcess {
  std::string name;                    ///< For messages.
  std::vector<std::string> arguments;  ///< The program's path first.
  bool may_end = false;  ///< Its end with exit code 0 or 3 (the log is cut) is no accident.
};

/// Child processes that are started again when they die, and that never outlive this process: they
/// end with the object, and the kernel kills them when this process is killed. Their output goes to
/// NAME.log in the log folder.
class ServiceProcesses {
 public:
  static constexpr int kMostRestarts = 20;  ///< Of one service in a row; then it is broken.

  /// Throws std::runtime_error, one line, when a program cannot be started.
  ServiceProcesses(std::vector<ServiceProcess> services, std::filesystem::path log_folder,
                   std::map<std::string, std::string> environment);
  ~ServiceProcesses();  ///< SIGTERM to all, SIGKILL to what has not ended after 2 s.
  ServiceProcesses(const ServiceProcesses&) = delete;
  ServiceProcesses& operator=(const ServiceProcesses&) = delete;

  /// Starts again what has died. Otherwise why there is no point in it, with the service's last
  /// words.
  std::optional<std::string> restart_dead();

  /// Ends one for good: SIGTERM, SIGKILL after 2 s.
  void end(const std::string& name);

  /// Exit code of a service that may end and has.
  std::optional<int> ended(const std::string& name) const;

  const std::map<std::string, std::uint64_t>& restarts() const { return restarts_; }

 private:
  struct Running {
    ServiceProcess service;
    pid_t process = 0;  ///< 0: has ended.
    std::optional<int> exit_code;
    std::chrono::steady_clock::time_point started;
    int failed_at_once = 0;
  };

  void start(Running& running);
  void end(const std::function<bool(const Running&)>& is_meant);
  std::string last_words(const std::string& name) const;

  std::vector<Running> all_;
  std::filesystem::path log_folder_;
  std::vector<std::string> environment_;
  std::map<std::string, std::uint64_t> restarts_;
};

/// A folder of its own under the system's temporary one, removed with everything in it at the end.
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

/// Folder of this executable: where the services' are, too.
std::filesystem::path folder_of_this_program();

}  // namespace slammot
