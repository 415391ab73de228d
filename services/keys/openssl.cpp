#include "services/keys/openssl.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

extern char** environ;

namespace slammot::keys {
namespace {

std::string last_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// Reads to the end and closes.
std::string content_of(int pipe) {
  std::string text;
  char bytes[4096];
  for (ssize_t length = 0; (length = read(pipe, bytes, sizeof bytes)) > 0;)
    text.append(bytes, static_cast<std::size_t>(length));
  close(pipe);
  return text;
}

/// Starts the command with both of its outputs in `output`; 0 or an error number.
int spawn(const std::filesystem::path& folder, char* const* arguments, int output, pid_t& process) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  const int fault = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  return fault;
}

files::Error cannot_run(int fault) {
  return {"cannot run openssl: " + std::string(std::strerror(fault))};
}

}  // namespace

files::Result<std::string> openssl(const std::filesystem::path& folder,
                                   std::vector<std::string> arguments) {
  std::vector<char*> call = {const_cast<char*>("openssl")};
  for (std::string& argument : arguments) call.push_back(argument.data());
  call.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return cannot_run(errno);
  pid_t process = 0;
  const int fault = spawn(folder, call.data(), ends[1], process);
  close(ends[1]);
  const std::string text = content_of(ends[0]);
  if (fault != 0) return cannot_run(fault);
  int status = 0;
  waitpid(process, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
  return files::Error{"openssl " + arguments.front() + ": " + last_line(text)};
}

}  // namespace slammot::keys
