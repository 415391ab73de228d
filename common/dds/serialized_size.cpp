#include "common/dds/serialized_size.hpp"

#include <string>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>

#include "common/dds/entity.hpp"

namespace slammot::dds {

std::size_t serialized_sample_bytes(const TopicInfo& topic, const void* sample) {
  dds_ostream_t stream;
  dds_ostream_init(&stream, 0, CDR_ENC_VERSION_2);
  const bool fits =
      dds_stream_write(&stream, static_cast<const char*>(sample), topic.type->m_ops) != nullptr;
  const std::size_t bytes = stream.m_index;
  dds_ostream_fini(&stream);
  if (!fits) throw Error(std::string(topic.name) + ": the sample breaks its type's limits");
  return bytes;
}

}  // namespace slammot::dds
