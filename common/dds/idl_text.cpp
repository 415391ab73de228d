#include "common/dds/idl_text.hpp"

#include <algorithm>

namespace slammot::dds {
namespace {

template <typename Number>
std::string around(std::string text, Number number, const char* after) {
  return text.append(std::to_string(number)).append(after);
}

std::string word_of(const TypeUse& use) {
  switch (use.kind) {
    case TypeKind::kBoolean: return "boolean";
    case TypeKind::kByte: return "octet";
    case TypeKind::kChar: return "char";
    case TypeKind::kInt16: return "int16";
    case TypeKind::kInt32: return "int32";
    case TypeKind::kInt64: return "int64";
    case TypeKind::kUint16: return "uint16";
    case TypeKind::kUint32: return "uint32";
    case TypeKind::kUint64: return "uint64";
    case TypeKind::kFloat32: return "float";
    case TypeKind::kFloat64: return "double";
    case TypeKind::kString: return use.bound == 0 ? "string" : around("string<", use.bound, ">");
    case TypeKind::kSequence:
      return std::string("sequence<")
          .append(word_of(use.element.front()))
          .append(use.bound == 0 ? ">" : around(", ", use.bound, ">"));
    case TypeKind::kArray: return word_of(use.element.front());
    case TypeKind::kNamed: return use.name;
    case TypeKind::kUnknown: return {};
  }
  return {};
}

/// "double covariance[16]"
std::string declaration(const TypeUse& use, const std::string& name) {
  const std::string word = word_of(use);
  if (word.empty()) return "// not described: " + name;
  std::string text = word + " " + name;
  for (const std::uint32_t length : use.lengths) text += around("[", length, "]");
  return text;
}

std::string annotations(const TypeMember& member) {
  return std::string(member.is_key ? "@key " : "") + (member.is_optional ? "@optional " : "") +
         (member.is_external ? "@external " : "");
}

std::string annotations(const NamedType& type) {
  const char* const how = type.extensibility == Extensibility::kFinal        ? "@final "
                          : type.extensibility == Extensibility::kAppendable ? "@appendable "
                                                                             : "@mutable ";
  return std::string(how) + (type.is_nested ? "@nested " : "");
}

std::string member_id(const NamedType& type, const TypeMember& member) {
  return type.extensibility == Extensibility::kMutable ? around("@id(", member.member_id, ") ")
                                                       : "";
}

std::string struct_text(const NamedType& type, const std::string& name) {
  std::string text = annotations(type) + "struct " + name;
  if (!type.base.empty()) text += " : " + type.base;
  text += " {\n";
  for (const TypeMember& member : type.members)
    text.append("  ")
        .append(member_id(type, member))
        .append(annotations(member))
        .append(declaration(member.type, member.name))
        .append(";\n");
  return text + "};\n";
}

std::string union_text(const NamedType& type, const std::string& name) {
  std::string text = annotations(type);
  text.append("union ").append(name).append(" switch (").append(word_of(type.use)).append(") {\n");
  for (const TypeMember& member : type.members) {
    for (const std::int32_t label : member.labels) text += around("  case ", label, ":\n");
    if (member.is_default) text += "  default:\n";
    text.append("    ")
        .append(annotations(member))
        .append(declaration(member.type, member.name))
        .append(";\n");
  }
  return text + "};\n";
}

std::string values_text(const NamedType& type, const std::string& name, const char* word,
                        const char* annotation) {
  std::string text;
  if (type.bits != 32) text = around("@bit_bound(", type.bits, ") ");
  text.append(word).append(" ").append(name).append(" {\n");
  std::int32_t expected = 0;
  for (const auto& [value_name, value] : type.values) {
    text.append("  ");
    if (value != expected) text.append(annotation).append(around("(", value, ") "));
    text.append(value_name).append(value_name == type.values.back().first ? "\n" : ",\n");
    expected = value + 1;
  }
  return text + "};\n";
}

std::string text_of(const NamedType& type, const std::string& name) {
  switch (type.kind) {
    case NamedType::Kind::kStruct: return struct_text(type, name);
    case NamedType::Kind::kUnion: return union_text(type, name);
    case NamedType::Kind::kEnum: return values_text(type, name, "enum", "@value");
    case NamedType::Kind::kBitmask: return values_text(type, name, "bitmask", "@position");
    case NamedType::Kind::kAlias:
      return std::string("typedef ").append(declaration(type.use, name)).append(";\n");
    case NamedType::Kind::kOther: return "// not described: " + name + "\n";
  }
  return {};
}

/// Each type in its modules, which may be opened again.
std::string in_modules(const NamedType& type) {
  std::string begin;
  std::string end;
  std::size_t at = 0;
  for (std::size_t next = type.name.find("::"); next != std::string::npos;
       next = type.name.find("::", at)) {
    begin.append("module ").append(type.name.substr(at, next - at)).append(" {\n");
    end += "};\n";
    at = next + 2;
  }
  return begin + text_of(type, type.name.substr(at)) + end;
}

}  // namespace

std::string idl_text(const TypeModel& model) {
  std::string text;
  for (const NamedType& type : model.types)
    text.append(text.empty() ? "" : "\n").append(in_modules(type));
  return text;
}

}  // namespace slammot::dds
