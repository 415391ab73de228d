#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/dds/entity.hpp"

namespace slammot::dds {

/// The bus cannot be joined as configured. what() is one line for the user, with the library's own
/// reason.
class StartupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ParticipantOptions {
  std::uint32_t domain_id = 0;        ///< 0 to 230.
  std::string name;                   ///< What the stock tools show, e.g. "slammot-localization".
  std::optional<std::string> config;  ///< Cyclone XML; config_from_environment() when not set.
};

/// Participant in a DDS domain. Must outlive everything created from it.
/// Participants of one process in the same domain share the configuration of the first.
class Participant {
 public:
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(Participant&&) noexcept;

  Entity::Handle handle() const { return entity_.handle(); }
  std::uint32_t domain_id() const { return domain_id_; }

 private:
  class Domain;
  static std::shared_ptr<Domain> open_domain(const ParticipantOptions& options);

  std::uint32_t domain_id_;
  std::shared_ptr<Domain> domain_;  // before entity_: deleted after it
  Entity entity_;
};

}  // namespace slammot::dds
