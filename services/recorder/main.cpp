#include "services/recorder/recorder_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::recorder::RecorderService>(argc, argv);
}
