#include "common/dds/opaque_type.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/q_radmin.h>

#include "common/dds/cdr_walk.hpp"
#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {
namespace {

/// The library's type, followed by ours.
struct OpaqueType {
  ddsi_sertype base;
  std::shared_ptr<const RawTopic> topic;
  Instances instances;
};

/// The library's sample, followed by ours. The bytes are followed by zeros to a multiple of 4.
struct OpaqueSample {
  ddsi_serdata base;
  std::vector<std::uint8_t> cdr;
  std::uint32_t size;
  std::vector<std::uint8_t> key;
};

const OpaqueType& of(const ddsi_sertype* type) {
  return *reinterpret_cast<const OpaqueType*>(type);
}
const OpaqueSample& of(const ddsi_serdata* sample) {
  return *reinterpret_cast<const OpaqueSample*>(sample);
}

/// FNV-1a, 32 bits.
std::uint32_t hash_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t hash = 2166136261U;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 16777619U;
  return hash;
}

ddsi_sertype_cdr_data lent(const std::vector<std::uint8_t>& bytes) {
  return {static_cast<std::uint32_t>(bytes.size()), const_cast<std::uint8_t*>(bytes.data())};
}

OpaqueSample* make_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto* const sample = new OpaqueSample{};
  ddsi_serdata_init(&sample->base, type, kind);
  sample->size = static_cast<std::uint32_t>(size);
  sample->cdr.resize((size + 3) / 4 * 4);
  return sample;
}

/// Null, and the sample is freed, if its key cannot be read.
ddsi_serdata* finish(OpaqueSample* sample) {
  const OpaqueType& type = of(sample->base.type);
  const bool needs_key = type.instances == Instances::kByKey && sample->base.kind == SDK_DATA;
  if (needs_key &&
      !copy_key(type.topic->model(), {sample->cdr.data(), sample->size}, sample->key)) {
    delete sample;
    return nullptr;
  }
  sample->base.hash = hash_of(sample->key) ^ type.base.serdata_basehash;
  return &sample->base;
}

bool has_same_key(const ddsi_serdata* a, const ddsi_serdata* b) { return of(a).key == of(b).key; }

std::uint32_t size_of(const ddsi_serdata* sample) { return of(sample).size; }

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  OpaqueSample* const sample = make_sample(type, kind, size);
  std::uint32_t at = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= at || fragment->min > at || fragment->maxp1 > size) continue;
    const unsigned char* const payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(sample->cdr.data() + at, payload + (at - fragment->min), fragment->maxp1 - at);
    at = fragment->maxp1;
  }
  return finish(sample);
}

ddsi_serdata* from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) {
  OpaqueSample* const sample = make_sample(type, kind, size);
  std::size_t at = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && at < size; ++i) {
    const std::size_t length = std::min<std::size_t>(parts[i].iov_len, size - at);
    std::memcpy(sample->cdr.data() + at, parts[i].iov_base, length);
    at += length;
  }
  return finish(sample);
}

ddsi_serdata* from_keyhash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return finish(make_sample(type, SDK_KEY, 4));
}

ddsi_serdata* from_sample(const ddsi_sertype*, ddsi_serdata_kind, const void*) { return nullptr; }

void to_bytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* into) {
  std::memcpy(into, of(sample).cdr.data() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size,
                         ddsrt_iovec_t* bytes) {
  bytes->iov_base = const_cast<std::uint8_t*>(of(sample).cdr.data()) + offset;
  bytes->iov_len = size;
  return ddsi_serdata_ref(sample);
}

void take_back_bytes(ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); }

bool to_sample(const ddsi_serdata*, void*, void**, void*) { return false; }

ddsi_serdata* to_untyped(const ddsi_serdata* sample) {
  OpaqueSample* const key = make_sample(sample->type, SDK_KEY, 0);
  key->key = of(sample).key;
  key->base.hash = sample->hash;
  key->base.type = nullptr;
  return &key->base;
}

bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return false;
}

void free_sample(ddsi_serdata* sample) { delete reinterpret_cast<OpaqueSample*>(sample); }

std::size_t print(const ddsi_sertype*, const ddsi_serdata* sample, char* into, std::size_t size) {
  return static_cast<std::size_t>(std::snprintf(into, size, "(%u bytes)", of(sample).size));
}

/// Only what may need it for its own tables asks for it: receivers compute theirs from the sample.
void get_keyhash(const ddsi_serdata* sample, ddsi_keyhash* into, bool) {
  const std::uint32_t hash = hash_of(of(sample).key);
  for (std::size_t i = 0; i < sizeof into->value; i += sizeof hash)
    std::memcpy(into->value + i, &hash, sizeof hash);
}

const ddsi_serdata_ops& sample_calls() {
  static const ddsi_serdata_ops calls = [] {
    ddsi_serdata_ops made{};
    made.eqkey = has_same_key;
    made.get_size = size_of;
    made.from_ser = from_fragments;
    made.from_ser_iov = from_parts;
    made.from_keyhash = from_keyhash;
    made.from_sample = from_sample;
    made.to_ser = to_bytes;
    made.to_ser_ref = lend_bytes;
    made.to_ser_unref = take_back_bytes;
    made.to_sample = to_sample;
    made.to_untyped = to_untyped;
    made.untyped_to_sample = untyped_to_sample;
    made.free = free_sample;
    made.print = print;
    made.get_keyhash = get_keyhash;
    return made;
  }();
  return calls;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete reinterpret_cast<OpaqueType*>(type);
}

bool is_same_type(const ddsi_sertype* a, const ddsi_sertype* b) {
  return of(a).instances == of(b).instances && of(a).topic->type() == of(b).topic->type();
}

std::uint32_t hash_of_type(const ddsi_sertype* type) {
  return hash_of(of(type).topic->type().information) +
         static_cast<std::uint32_t>(of(type).instances);
}

ddsi_typeinfo_t* information_of(const ddsi_sertype* type) {
  const ddsi_sertype_cdr_data bytes = lent(of(type).topic->type().information);
  return ddsi_typeinfo_deser(&bytes);
}

ddsi_typemap_t* mapping_of(const ddsi_sertype* type) {
  const ddsi_sertype_cdr_data bytes = lent(of(type).topic->type().mapping);
  return ddsi_typemap_deser(&bytes);
}

ddsi_typeid_t* id_of(const ddsi_sertype* type, ddsi_typeid_kind_t kind) {
  ddsi_typeinfo_t* const information = information_of(type);
  if (information == nullptr) return nullptr;
  ddsi_typeid_t* const id = ddsi_typeinfo_typeid(information, kind);
  ddsi_typeinfo_fini(information);
  dds_free(information);
  return id;
}

/// Samples are the same bytes in every representation.
ddsi_sertype* derive(const ddsi_sertype* type, dds_data_representation_id_t,
                     dds_type_consistency_enforcement_qospolicy_t) {
  return const_cast<ddsi_sertype*>(type);
}

const ddsi_sertype_ops& type_calls() {
  static const ddsi_sertype_ops calls = [] {
    ddsi_sertype_ops made{};
    made.version = ddsi_sertype_v0;
    made.free = free_type;
    made.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
    made.realloc_samples = [](void** samples, const ddsi_sertype*, void*, std::size_t,
                              std::size_t count) { std::fill_n(samples, count, nullptr); };
    made.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
    made.equal = is_same_type;
    made.hash = hash_of_type;
    made.type_id = id_of;
    made.type_map = mapping_of;
    made.type_info = information_of;
    made.derive_sertype = derive;
    made.get_serialized_size = [](const ddsi_sertype*, const void*) { return SIZE_MAX; };
    made.serialize_into = [](const ddsi_sertype*, const void*, void*, std::size_t) {
      return false;
    };
    return made;
  }();
  return calls;
}

}  // namespace

OpaqueTopic create_opaque_topic(const Participant& participant,
                                std::shared_ptr<const RawTopic> topic, const OfferedQos& offered,
                                Instances instances) {
  const std::string name(topic->info().name);
  auto* const type = new OpaqueType{{}, topic, instances};
  ddsi_sertype_init(&type->base, topic->type().name.c_str(), &type_calls(), &sample_calls(),
                    !is_keyed(topic->model()));
  type->base.allowed_data_representation = DDS_DATA_REPRESENTATION_RESTRICT_DEFAULT;
  const QosPointer qos(dds_create_qos(), dds_delete_qos);
  const dds_data_representation_id_t representation = offered.representation;
  dds_qset_data_representation(qos.get(), 1, &representation);
  ddsi_sertype* used = &type->base;
  const dds_entity_t made = dds_create_topic_sertype(participant.handle(), name.c_str(), &used,
                                                     qos.get(), nullptr, nullptr);
  if (made < 0) free_type(&type->base);
  return {Entity(made, "topic " + name), used};
}

}  // namespace slammot::dds
