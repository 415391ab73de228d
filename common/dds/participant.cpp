#include "common/dds/participant.hpp"

#include <map>
#include <mutex>

#include <dds/dds.h>

#include "common/dds/config.hpp"
#include "common/dds/log.hpp"
#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {
namespace {

std::string reason(std::int32_t code, const LogCapture& log) {
  const std::string errors = log.errors();
  return errors.empty() ? dds_strretcode(code) : errors;
}

Entity create_domain(const ParticipantOptions& options) {
  const std::string config = options.config.value_or(config_from_environment());
  const LogCapture log;
  const dds_entity_t domain = dds_create_domain(options.domain_id, config.c_str());
  if (domain < 0) {
    throw StartupError("cannot join DDS domain " + std::to_string(options.domain_id) + ": " +
                       reason(domain, log));
  }
  return {domain, "domain"};
}

Entity create_participant(const ParticipantOptions& options) {
  const QosPointer qos(dds_create_qos(), dds_delete_qos);
  dds_qset_entity_name(qos.get(), options.name.c_str());
  const LogCapture log;
  const dds_entity_t participant = dds_create_participant(options.domain_id, qos.get(), nullptr);
  if (participant < 0) {
    throw StartupError("cannot create a participant in DDS domain " +
                       std::to_string(options.domain_id) + ": " + reason(participant, log));
  }
  return {participant, "participant"};
}

}  // namespace

class Participant::Domain {
 public:
  explicit Domain(const ParticipantOptions& options) : entity_(create_domain(options)) {}

 private:
  Entity entity_;
};

std::shared_ptr<Participant::Domain> Participant::open_domain(const ParticipantOptions& options) {
  // The library creates each domain once a process, therefore this table is global, too.
  static std::mutex mutex;
  static std::map<std::uint32_t, std::weak_ptr<Domain>> open_domains;
  const std::scoped_lock lock(mutex);
  std::weak_ptr<Domain>& known = open_domains[options.domain_id];
  std::shared_ptr<Domain> domain = known.lock();
  if (!domain) {
    domain = std::make_shared<Domain>(options);
    known = domain;
  }
  return domain;
}

Participant::Participant(const ParticipantOptions& options)
    : domain_id_(options.domain_id),
      domain_(open_domain(options)),
      entity_(create_participant(options)) {}

Participant::~Participant() = default;
Participant::Participant(Participant&&) noexcept = default;

}  // namespace slammot::dds
