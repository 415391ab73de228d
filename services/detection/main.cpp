#include "services/detection/detection_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::detection::DetectionService>(argc, argv);
}
