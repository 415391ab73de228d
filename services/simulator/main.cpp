#include "services/simulator/simulator_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::simulator::SimulatorService>(argc, argv);
}
