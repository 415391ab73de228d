#include "services/tracking/tracking_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::tracking::TrackingService>(argc, argv);
}
