#pragma once

#include <vector>

#include <dds/dds.h>

#include "common/dds/discovery.hpp"

namespace slammot::dds {

/// What the C library's QoS of an endpoint says; only for the sources of this folder.
EndpointQos endpoint_qos(const dds_qos_t* qos);

/// How the endpoint describes its type; null if it does not. Owned by the endpoint.
const dds_typeinfo_t* type_information(dds_builtintopic_endpoint_t& endpoint);

/// Identity of the endpoint's type; empty if the endpoint does not tell it.
std::vector<unsigned char> type_hash(dds_builtintopic_endpoint_t& endpoint);

}  // namespace slammot::dds
