#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace slammot::gateway {

/// What viewers may ask of a service on the bus: a "service" of the Foxglove protocol.
struct CallableService {
  std::uint32_t id = 0;
  std::string_view name;      ///< For viewers: "/player/seek".
  std::string_view service;   ///< On the bus: "player".
  std::string_view verb;      ///< Of the command to it.
  std::string_view argument;  ///< Number in the request's JSON that it takes; empty: none.
};

/// The index is the id.
std::span<const CallableService> callable_services();

/// Message that tells viewers of them.
std::string services_advertisement();

struct ServiceCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;  ///< Chosen by the client.
  std::string argument;    ///< As text; empty: none.
};

/// Reads a request of a client; any bytes may come. None if it is malformed, or asks for no
/// service.
std::optional<ServiceCall> parse_service_call(std::string_view bytes);

/// Answers: binary where it is done, JSON where not.
std::string service_response(const ServiceCall& call);
std::string call_failure(const ServiceCall& call, const std::string& explanation);

/// A call of a viewer on its way to the bus.
struct ViewerCall {
  const CallableService* service = nullptr;
  std::string argument;
  /// From any thread; an empty explanation: done.
  std::function<void(std::string explanation)> answer;
};

}  // namespace slammot::gateway
