#include "services/loop_closing/loop_closing_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::loop_closing::LoopClosingService>(argc, argv);
}
