#include "services/gateway/calls.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/files/text.hpp"

namespace slammot::gateway {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kJson = "json";
constexpr std::uint8_t kRequest = 2;
constexpr std::uint8_t kResponse = 3;
constexpr std::size_t kHeaderBytes = 13;  ///< Opcode, service, call, length of the encoding's name.

constexpr std::array<CallableService, 6> kServices = {{
    {0, "/player/pause", "player", "pause", ""},
    {1, "/player/go_on", "player", "go_on", ""},
    {2, "/player/step", "player", "step", "seconds"},
    {3, "/player/seek", "player", "seek", "seconds"},
    {4, "/player/speed", "player", "speed", "speed"},
    {5, "/map/save", "localization", "finish_submap", ""},
}};

std::string request_schema(const CallableService& service) {
  Json schema = {{"type", "object"}, {"properties", Json::object()}};
  if (!service.argument.empty())
    schema["properties"][std::string(service.argument)] = {{"type", "number"}};
  return schema.dump();
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < sizeof number; ++i)
    number |= std::uint32_t{static_cast<std::uint8_t>(bytes[at + i])} << (8 * i);
  return number;
}

void append(std::uint32_t number, std::string& into) {
  for (std::size_t i = 0; i < sizeof number; ++i) into += static_cast<char>(number >> (8 * i));
}

std::optional<std::string> argument_in(std::string_view payload, std::string_view name) {
  if (name.empty()) return "";
  const Json request = Json::parse(payload, nullptr, false);
  if (!request.is_object()) return std::nullopt;
  const auto value = request.find(name);
  if (value == request.end() || !value->is_number()) return std::nullopt;
  return files::text("%.9g", value->get<double>());
}

}  // namespace

std::span<const CallableService> callable_services() { return kServices; }

std::string services_advertisement() {
  Json list = Json::array();
  for (const CallableService& service : kServices) {
    const std::string type = "slammot" + std::string(service.name);
    const std::string schema = request_schema(service);
    const auto side = [&](const char* kind, const std::string& text) {
      return Json{{"encoding", kJson},
                  {"schemaName", type + kind},
                  {"schemaEncoding", "jsonschema"},
                  {"schema", text}};
    };
    list.push_back({{"id", service.id},
                    {"name", service.name},
                    {"type", type},
                    {"requestSchema", schema},
                    {"responseSchema", R"({"type":"object"})"},
                    {"request", side("Request", schema)},
                    {"response", side("Response", R"({"type":"object"})")}});
  }
  return Json{{"op", "advertiseServices"}, {"services", std::move(list)}}.dump();
}

std::optional<ServiceCall> parse_service_call(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes || static_cast<std::uint8_t>(bytes[0]) != kRequest)
    return std::nullopt;
  const std::uint32_t service = number_at(bytes, 1);
  const std::uint32_t length = number_at(bytes, 9);
  if (service >= kServices.size() || length != kJson.size()) return std::nullopt;
  const std::string_view rest = bytes.substr(kHeaderBytes);
  if (!rest.starts_with(kJson)) return std::nullopt;
  const auto argument = argument_in(rest.substr(length), kServices[service].argument);
  if (!argument) return std::nullopt;
  return ServiceCall{service, number_at(bytes, 5), *argument};
}

std::string service_response(const ServiceCall& call) {
  std::string bytes(1, static_cast<char>(kResponse));
  append(call.service, bytes);
  append(call.call, bytes);
  append(static_cast<std::uint32_t>(kJson.size()), bytes);
  return bytes.append(kJson).append("{}");
}

std::string call_failure(const ServiceCall& call, const std::string& explanation) {
  const Json message = {{"op", "serviceCallFailure"},
                        {"serviceId", call.service},
                        {"callId", call.call},
                        {"message", explanation}};
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace slammot::gateway
