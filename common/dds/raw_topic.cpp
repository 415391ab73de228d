#include "common/dds/raw_topic.hpp"

#include <algorithm>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>  // before the next ones, which need it
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_typewrap.h>
#include <dds/ddsi/ddsi_xt_impl.h>

namespace slammot::dds {
namespace {

using Pairs = std::vector<DDS_XTypes_TypeIdentifierTypeObjectPair>;

/// As the library describes types to others: XCDR2, little endian.
std::vector<std::uint8_t> serialized(const void* value, const dds_topic_descriptor_t& layout) {
  dds_ostreamLE_t stream;
  dds_ostreamLE_init(&stream, 0, CDR_ENC_VERSION_2);
  std::vector<std::uint8_t> bytes;
  if (dds_stream_writeLE(&stream, static_cast<const char*>(value), layout.m_ops) != nullptr)
    bytes.assign(stream.x.m_buffer, stream.x.m_buffer + stream.x.m_index);
  dds_ostreamLE_fini(&stream);
  return bytes;
}

std::vector<std::uint8_t> bytes_of(const dds_type_meta_ser& of_descriptor) {
  return {of_descriptor.data, of_descriptor.data + of_descriptor.sz};
}

/// Objects of the types, which the library lends until `owned` is freed. False if one is not known
/// in time.
class TypeObjects {
 public:
  TypeObjects(const Participant& participant, std::chrono::nanoseconds patience)
      : participant_(participant), patience_(patience) {}
  ~TypeObjects() {
    for (dds_typeobj_t* object : owned_) dds_free_typeobj(object);
  }
  TypeObjects(const TypeObjects&) = delete;
  TypeObjects& operator=(const TypeObjects&) = delete;

  bool add(const DDS_XTypes_TypeIdentifierWithDependencies& types, Pairs& pairs) {
    if (!add(types.typeid_with_size.type_id, pairs)) return false;
    for (std::uint32_t i = 0; i < types.dependent_typeids._length; ++i) {
      if (!add(types.dependent_typeids._buffer[i].type_id, pairs)) return false;
    }
    return true;
  }

 private:
  bool add(const DDS_XTypes_TypeIdentifier& type, Pairs& pairs) {
    const bool has_object = type._d == DDS_XTypes_EK_COMPLETE || type._d == DDS_XTypes_EK_MINIMAL;
    if (!has_object) return true;
    dds_typeobj_t* object = nullptr;
    const auto* id = reinterpret_cast<const dds_typeid_t*>(&type);  // its only member
    const dds_return_t code =
        dds_get_typeobj(participant_.handle(), id, patience_.count(), &object);
    if (code != DDS_RETCODE_OK || object == nullptr) return false;
    owned_.push_back(object);
    pairs.push_back({type, object->x});
    return true;
  }

  const Participant& participant_;
  std::chrono::nanoseconds patience_;
  std::vector<dds_typeobj_t*> owned_;
};

template <typename Sequence>
void lend(Pairs& pairs, Sequence& sequence) {
  sequence._buffer = pairs.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(pairs.size());
}

/// Asks for all that the type consists of. Empty if it is not known in time.
std::vector<std::uint8_t> fetch_mapping(const Participant& participant,
                                        const DDS_XTypes_TypeInformation& information,
                                        std::chrono::nanoseconds patience) {
  TypeObjects objects(participant, patience);
  Pairs complete;
  Pairs minimal;
  if (!objects.add(information.complete, complete) || !objects.add(information.minimal, minimal))
    return {};
  std::vector<DDS_XTypes_TypeIdentifierPair> same;
  for (std::size_t i = 0; i < std::min(complete.size(), minimal.size()); ++i)
    same.push_back({complete[i].type_identifier, minimal[i].type_identifier});
  DDS_XTypes_TypeMapping mapping{};
  lend(minimal, mapping.identifier_object_pair_minimal);
  lend(complete, mapping.identifier_object_pair_complete);
  mapping.identifier_complete_minimal._buffer = same.data();
  mapping.identifier_complete_minimal._length = mapping.identifier_complete_minimal._maximum =
      static_cast<std::uint32_t>(same.size());
  return serialized(&mapping, DDS_XTypes_TypeMapping_desc);
}

RawType type_of(const TopicInfo& topic) {
  return {std::string(topic.type_name()), bytes_of(topic.type->type_information),
          bytes_of(topic.type->type_mapping)};
}

/// The type as compiled, if it is the same one: its identifier is a hash of all that it consists
/// of.
std::optional<RawType> compiled_type(const std::string& name, const ddsi_typeinfo& information) {
  for (const TopicInfo* topic : topic_table()) {
    if (topic->type_name() != name) continue;
    RawType type = type_of(*topic);
    const ddsi_sertype_cdr_data bytes = {static_cast<std::uint32_t>(type.information.size()),
                                         type.information.data()};
    ddsi_typeinfo_t* const compiled = ddsi_typeinfo_deser(&bytes);
    const bool is_same = ddsi_typeid_compare(ddsi_typeinfo_complete_typeid(compiled),
                                             ddsi_typeinfo_complete_typeid(&information)) == 0;
    ddsi_typeinfo_fini(compiled);
    dds_free(compiled);
    return is_same ? std::optional(type) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

RawTopic::RawTopic(std::string name, RawType type, TypeModel model)
    : name_(std::move(name)),
      type_(std::move(type)),
      model_(std::move(model)),
      info_{name_, nullptr, Flow::kSensor, Recorded::kYes} {}

std::shared_ptr<const RawTopic> RawTopic::resolve(const Participant& participant,
                                                  const std::string& name,
                                                  const std::string& type_name,
                                                  const ddsi_typeinfo& information,
                                                  std::chrono::nanoseconds patience) {
  if (const auto compiled = compiled_type(type_name, information)) return of_type(name, *compiled);
  return of_type(name, {type_name, serialized(&information.x, DDS_XTypes_TypeInformation_desc),
                        fetch_mapping(participant, information.x, patience)});
}

std::shared_ptr<const RawTopic> RawTopic::of_table(const TopicInfo& topic) {
  return of_type(std::string(topic.name), type_of(topic));
}

std::shared_ptr<const RawTopic> RawTopic::of_type(const std::string& name, const RawType& type) {
  auto model = model_of(type);
  if (!model) return nullptr;
  return std::shared_ptr<const RawTopic>(new RawTopic(name, type, *std::move(model)));
}

}  // namespace slammot::dds
