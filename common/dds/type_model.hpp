#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/dds/raw_type.hpp"

namespace slammot::dds {

enum class TypeKind : std::uint8_t {
  kBoolean,
  kByte,
  kChar,
  kInt16,
  kInt32,
  kInt64,
  kUint16,
  kUint32,
  kUint64,
  kFloat32,
  kFloat64,
  kString,
  kSequence,  ///< Of its element.
  kArray,     ///< Of its element.
  kNamed,     ///< A type of the model.
  kUnknown,   ///< That this model does not describe: maps, wide strings.
};

/// Type of a member.
struct TypeUse {
  TypeKind kind = TypeKind::kUnknown;
  std::string name = {};                    ///< Of a named one.
  std::uint32_t bound = 0;                  ///< Longest string or sequence; 0: unlimited.
  std::vector<std::uint32_t> lengths = {};  ///< Of an array, outermost first.
  std::vector<TypeUse> element = {};        ///< One, of a sequence or array.
};

struct TypeMember {
  std::string name;
  TypeUse type;
  std::uint32_t member_id = 0;
  bool is_key = false;
  bool is_optional = false;
  bool is_external = false;
  bool is_default = false;                ///< Of a union: its default branch.
  std::vector<std::int32_t> labels = {};  ///< Of a union.
};

enum class Extensibility : std::uint8_t { kFinal, kAppendable, kMutable };

/// A struct, enum, union, bitmask or alias.
struct NamedType {
  enum class Kind : std::uint8_t { kStruct, kEnum, kUnion, kBitmask, kAlias, kOther };
  Kind kind = Kind::kOther;
  std::string name;  ///< "slammot::LaserScan"
  Extensibility extensibility = Extensibility::kFinal;
  bool is_nested = false;
  std::string base;  ///< Of a struct that inherits; empty otherwise.
  std::vector<TypeMember> members;
  std::vector<std::pair<std::string, std::int32_t>> values;  ///< Of an enum; bits of a bitmask.
  std::uint32_t bits = 32;                                   ///< Of an enum or bitmask.
  TypeUse use;  ///< What an alias stands for; the discriminator of a union.
};

/// A topic's type and all types that it consists of, each after those that it consists of.
struct TypeModel {
  std::vector<NamedType> types;

  const NamedType* find(const std::string& name) const;
};

/// None if the description is damaged, or lacks names because its writer was built without them.
std::optional<TypeModel> model_of(const RawType& type);

/// Whether the bytes are what the library reads as TypeInformation and TypeMapping: it does not
/// check them itself.
bool is_sound(const RawType& type);

}  // namespace slammot::dds
