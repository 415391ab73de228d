#include "services/slammot/command_line.hpp"

int main(int argc, char** argv) { return slammot::run_command_line(argc, argv); }
