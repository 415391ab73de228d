#include "common/dds/type_model.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_typewrap.h>
#include <dds/ddsi/ddsi_xt_impl.h>

namespace slammot::dds {
namespace {

using Hash = std::string;
using NameOf = std::map<Hash, std::string>;

Hash hash_of(const DDS_XTypes_TypeIdentifier& identifier) {
  const auto* bytes = reinterpret_cast<const char*>(identifier._u.equivalence_hash);
  return {bytes, sizeof identifier._u.equivalence_hash};
}

TypeKind primitive_of(std::uint8_t kind) {
  switch (kind) {
    case DDS_XTypes_TK_BOOLEAN: return TypeKind::kBoolean;
    case DDS_XTypes_TK_BYTE: return TypeKind::kByte;
    case DDS_XTypes_TK_CHAR8: return TypeKind::kChar;
    case DDS_XTypes_TK_INT16: return TypeKind::kInt16;
    case DDS_XTypes_TK_INT32: return TypeKind::kInt32;
    case DDS_XTypes_TK_INT64: return TypeKind::kInt64;
    case DDS_XTypes_TK_UINT16: return TypeKind::kUint16;
    case DDS_XTypes_TK_UINT32: return TypeKind::kUint32;
    case DDS_XTypes_TK_UINT64: return TypeKind::kUint64;
    case DDS_XTypes_TK_FLOAT32: return TypeKind::kFloat32;
    case DDS_XTypes_TK_FLOAT64: return TypeKind::kFloat64;
    default: return TypeKind::kUnknown;
  }
}

TypeUse use_of(const DDS_XTypes_TypeIdentifier& identifier, const NameOf& names);

TypeUse sequence_of(const DDS_XTypes_TypeIdentifier* element, std::uint32_t bound,
                    const NameOf& names) {
  TypeUse use{
      .kind = TypeKind::kSequence, .name = {}, .bound = bound, .lengths = {}, .element = {}};
  use.element.push_back(element == nullptr ? TypeUse{} : use_of(*element, names));
  return use;
}

template <typename Bounds>
TypeUse array_of(const DDS_XTypes_TypeIdentifier* element, const Bounds& bounds,
                 const NameOf& names) {
  TypeUse use = sequence_of(element, 0, names);
  use.kind = TypeKind::kArray;
  use.lengths.assign(bounds._buffer, bounds._buffer + bounds._length);
  return use;
}

TypeUse use_of(const DDS_XTypes_TypeIdentifier& identifier, const NameOf& names) {
  const auto& content = identifier._u;
  switch (identifier._d) {
    case DDS_XTypes_TI_STRING8_SMALL:
      return {.kind = TypeKind::kString, .name = {}, .bound = content.string_sdefn.bound};
    case DDS_XTypes_TI_STRING8_LARGE:
      return {.kind = TypeKind::kString, .name = {}, .bound = content.string_ldefn.bound};
    case DDS_XTypes_TI_PLAIN_SEQUENCE_SMALL:
      return sequence_of(content.seq_sdefn.element_identifier, content.seq_sdefn.bound, names);
    case DDS_XTypes_TI_PLAIN_SEQUENCE_LARGE:
      return sequence_of(content.seq_ldefn.element_identifier, content.seq_ldefn.bound, names);
    case DDS_XTypes_TI_PLAIN_ARRAY_SMALL:
      return array_of(content.array_sdefn.element_identifier, content.array_sdefn.array_bound_seq,
                      names);
    case DDS_XTypes_TI_PLAIN_ARRAY_LARGE:
      return array_of(content.array_ldefn.element_identifier, content.array_ldefn.array_bound_seq,
                      names);
    case DDS_XTypes_EK_COMPLETE: {
      const auto name = names.find(hash_of(identifier));
      if (name == names.end()) return {};
      return {.kind = TypeKind::kNamed, .name = name->second};
    }
    default: return {.kind = primitive_of(identifier._d)};
  }
}

Extensibility extensibility_of(DDS_XTypes_TypeFlag flags) {
  if ((flags & DDS_XTypes_IS_MUTABLE) != 0) return Extensibility::kMutable;
  return (flags & DDS_XTypes_IS_APPENDABLE) != 0 ? Extensibility::kAppendable
                                                 : Extensibility::kFinal;
}

template <typename Member>
TypeMember member_of(const Member& member, const DDS_XTypes_TypeIdentifier& type,
                     const NameOf& names) {
  const auto flags = member.common.member_flags;
  return {.name = member.detail.name,
          .type = use_of(type, names),
          .member_id = member.common.member_id,
          .is_key = (flags & DDS_XTypes_IS_KEY) != 0,
          .is_optional = (flags & DDS_XTypes_IS_OPTIONAL) != 0,
          .is_external = (flags & DDS_XTypes_IS_EXTERNAL) != 0,
          .is_default = (flags & DDS_XTypes_IS_DEFAULT) != 0};
}

void fill_struct(const DDS_XTypes_CompleteStructType& from, const NameOf& names, NamedType& type) {
  type.kind = NamedType::Kind::kStruct;
  type.extensibility = extensibility_of(from.struct_flags);
  type.is_nested = (from.struct_flags & DDS_XTypes_IS_NESTED) != 0;
  type.base = use_of(from.header.base_type, names).name;
  for (std::uint32_t i = 0; i < from.member_seq._length; ++i) {
    const auto& member = from.member_seq._buffer[i];
    type.members.push_back(member_of(member, member.common.member_type_id, names));
  }
}

void fill_union(const DDS_XTypes_CompleteUnionType& from, const NameOf& names, NamedType& type) {
  type.kind = NamedType::Kind::kUnion;
  type.extensibility = extensibility_of(from.union_flags);
  type.is_nested = (from.union_flags & DDS_XTypes_IS_NESTED) != 0;
  type.use = use_of(from.discriminator.common.type_id, names);
  for (std::uint32_t i = 0; i < from.member_seq._length; ++i) {
    const auto& member = from.member_seq._buffer[i];
    type.members.push_back(member_of(member, member.common.type_id, names));
    const auto& labels = member.common.label_seq;
    type.members.back().labels.assign(labels._buffer, labels._buffer + labels._length);
  }
}

void fill_enum(const DDS_XTypes_CompleteEnumeratedType& from, NamedType& type) {
  type.kind = NamedType::Kind::kEnum;
  type.bits = from.header.common.bit_bound;
  for (std::uint32_t i = 0; i < from.literal_seq._length; ++i) {
    const auto& literal = from.literal_seq._buffer[i];
    type.values.emplace_back(literal.detail.name, literal.common.value);
  }
}

void fill_bitmask(const DDS_XTypes_CompleteBitmaskType& from, NamedType& type) {
  type.kind = NamedType::Kind::kBitmask;
  type.bits = from.header.common.bit_bound;
  for (std::uint32_t i = 0; i < from.flag_seq._length; ++i) {
    const auto& flag = from.flag_seq._buffer[i];
    type.values.emplace_back(flag.detail.name, flag.common.position);
  }
}

const char* name_of(const DDS_XTypes_CompleteTypeObject& type) {
  switch (type._d) {
    case DDS_XTypes_TK_STRUCTURE: return type._u.struct_type.header.detail.type_name;
    case DDS_XTypes_TK_UNION: return type._u.union_type.header.detail.type_name;
    case DDS_XTypes_TK_ENUM: return type._u.enumerated_type.header.detail.type_name;
    case DDS_XTypes_TK_BITMASK: return type._u.bitmask_type.header.detail.type_name;
    case DDS_XTypes_TK_ALIAS: return type._u.alias_type.header.detail.type_name;
    default: return nullptr;
  }
}

NamedType type_of(const DDS_XTypes_CompleteTypeObject& from, const NameOf& names) {
  NamedType type;
  type.name = name_of(from);
  if (from._d == DDS_XTypes_TK_STRUCTURE) fill_struct(from._u.struct_type, names, type);
  if (from._d == DDS_XTypes_TK_UNION) fill_union(from._u.union_type, names, type);
  if (from._d == DDS_XTypes_TK_ENUM) fill_enum(from._u.enumerated_type, type);
  if (from._d == DDS_XTypes_TK_BITMASK) fill_bitmask(from._u.bitmask_type, type);
  if (from._d == DDS_XTypes_TK_ALIAS) {
    type.kind = NamedType::Kind::kAlias;
    type.use = use_of(from._u.alias_type.body.common.related_type, names);
  }
  return type;
}

/// Puts types after those that they consist of.
class Sorter {
 public:
  explicit Sorter(std::map<std::string, NamedType> types) : types_(std::move(types)) {}

  TypeModel sorted_from(const std::string& top) {
    visit(top);
    return std::move(model_);
  }

 private:
  void visit(const TypeUse& use) {
    if (use.kind == TypeKind::kNamed) visit(use.name);
    for (const TypeUse& element : use.element) visit(element);
  }
  void visit(const std::string& name) {
    const auto type = types_.find(name);
    if (type == types_.end() || !begun_.insert(name).second) return;
    if (!type->second.base.empty()) visit(type->second.base);
    visit(type->second.use);
    for (const TypeMember& member : type->second.members) visit(member.type);
    model_.types.push_back(type->second);
  }

  std::map<std::string, NamedType> types_;
  std::set<std::string> begun_;
  TypeModel model_;
};

ddsi_sertype_cdr_data serialized(const std::vector<std::uint8_t>& bytes) {
  // the library only reads it
  return {static_cast<std::uint32_t>(bytes.size()), const_cast<std::uint8_t*>(bytes.data())};
}

using TypeMap = std::unique_ptr<ddsi_typemap_t, void (*)(ddsi_typemap_t*)>;

void free_map(ddsi_typemap_t* map) {
  ddsi_typemap_fini(map);
  dds_free(map);
}

/// What the library reads without checking must not reach beyond its bytes.
bool is_sound(std::vector<std::uint8_t> bytes, const dds_topic_descriptor_t& layout) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  if (bytes.empty() || bytes.size() > kMostBytes) return false;
  std::uint32_t at = 0;
  return dds_stream_normalize_data(reinterpret_cast<char*>(bytes.data()), &at,
                                   static_cast<std::uint32_t>(bytes.size()), false,
                                   CDR_ENC_VERSION_2, layout.m_ops) != nullptr;
}

}  // namespace

const NamedType* TypeModel::find(const std::string& name) const {
  const auto type = std::ranges::find(types, name, &NamedType::name);
  return type == types.end() ? nullptr : &*type;
}

bool is_sound(const RawType& type) {
  return is_sound(type.information, DDS_XTypes_TypeInformation_desc) &&
         is_sound(type.mapping, DDS_XTypes_TypeMapping_desc);
}

std::optional<TypeModel> model_of(const RawType& type) {
  if (!is_sound(type)) return std::nullopt;
  const ddsi_sertype_cdr_data bytes = serialized(type.mapping);
  const TypeMap map(ddsi_typemap_deser(&bytes), free_map);
  if (!map) return std::nullopt;
  const auto& pairs = map->x.identifier_object_pair_complete;
  NameOf names;
  for (std::uint32_t i = 0; i < pairs._length; ++i) {
    const auto& object = pairs._buffer[i].type_object;
    const char* const name =
        object._d == DDS_XTypes_EK_COMPLETE ? name_of(object._u.complete) : nullptr;
    if (name != nullptr) names[hash_of(pairs._buffer[i].type_identifier)] = name;
  }
  std::map<std::string, NamedType> types;
  for (std::uint32_t i = 0; i < pairs._length; ++i) {
    if (!names.contains(hash_of(pairs._buffer[i].type_identifier))) continue;
    NamedType named = type_of(pairs._buffer[i].type_object._u.complete, names);
    types.emplace(named.name, named);
  }
  TypeModel model = Sorter(std::move(types)).sorted_from(type.name);
  if (model.types.empty()) return std::nullopt;
  return model;
}

}  // namespace slammot::dds
