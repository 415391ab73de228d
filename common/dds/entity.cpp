#include "common/dds/entity.hpp"

#include <dds/dds.h>

namespace slammot::dds {

std::int32_t check(std::int32_t code, const std::string& what) {
  if (code < 0) throw Error(what + ": " + dds_strretcode(code));
  return code;
}

Entity::Entity(Handle handle_or_error, const std::string& what)
    : handle_(check(handle_or_error, what)) {}

Entity::~Entity() {
  // Fails only if the participant or the domain, and with it the entity, was already deleted.
  if (handle_ > 0) dds_delete(handle_);
}

}  // namespace slammot::dds
