#include <filesystem>

#include "services/slammot/command_line.hpp"
#include "services/slammot/installed_environment.hpp"

int main(int argc, char** argv) {
  std::error_code unreadable;
  slammot::take_environment_of_services(
      std::filesystem::read_symlink("/proc/self/exe", unreadable));
  return slammot::run_command_line(argc, argv);
}
