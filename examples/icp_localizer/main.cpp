#include "examples/icp_localizer/icp_localizer_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::icp_localizer::IcpLocalizerService>(argc, argv);
}
