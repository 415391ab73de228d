#include "services/gateway/gateway_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::gateway::GatewayService>(argc, argv);
}
