#pragma once

#include <string>

#include "services/gateway/hub.hpp"
#include "services/gateway/service_board.hpp"

namespace slammot::gateway {

/// Everything that the services and the gateway count, in Prometheus' text format. Units are
/// seconds and bytes, totals end in _total.
std::string metrics_text(const std::string& vehicle_id, const ServiceBoard& board,
                         const HubCounters& hub, const GatewayFigures& figures,
                         ServiceBoard::Time now);

}  // namespace slammot::gateway
