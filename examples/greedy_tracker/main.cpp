#include "examples/greedy_tracker/greedy_tracker_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::greedy_tracker::GreedyTrackerService>(argc, argv);
}
