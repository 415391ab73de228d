#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace slammot::config {

/// Closed interval in the field's own unit.
struct Range {
  double lowest = std::numeric_limits<double>::lowest();
  double highest = std::numeric_limits<double>::max();
};

/// Squares and products of settings within these limits are finite and not 0.
inline constexpr Range kPositive{1e-9, 1e9};
inline constexpr Range kNotNegative{0.0, kPositive.highest};
inline constexpr Range kShare{0.0, 1.0};

/// What settings are about: the order of listings.
enum class Group {
  sensor,
  odometry,
  map,
  matching,
  closing,
  motion,
  association,
  extent,
  existence,
  publication,
  warning,
  operation,
  log,
  none
};

std::string_view name_of(Group group);
std::string_view description_of(Group group);

/// What goes wrong when a setting is off. Either is empty where the meaning says it.
struct Consequences {
  std::string_view too_small = {};
  std::string_view too_large = {};
};

struct BoundField;

/// One of several names: an enum with the same numbers in C++ and in the proto.
struct Choice {
  std::function<int()> get;
  std::function<void(int)> set;
};

/// A repeated struct. A list in a text replaces the old content.
struct List {
  std::function<void()> clear;
  std::function<std::vector<BoundField>()> append;  ///< Appends a struct with defaults and returns
                                                    ///< its bound fields.
};

/// Location of a setting in a configuration struct; valid as long as the struct.
using Value = std::variant<bool*, int*, std::uint32_t*, std::int64_t*, std::uint64_t*, float*,
                           double*, std::string*, Choice, List>;

template <class Member>
Value value_in(Member& member) {
  if constexpr (std::is_enum_v<Member>) {
    return Choice{[&member] { return static_cast<int>(member); },
                  [&member](int number) { member = static_cast<Member>(number); }};
  } else {
    return &member;
  }
}

/// One row of a stage's field table: {"name as in slammot.proto", pointer to member, "meaning",
/// range, {"too small", "too large"}}. The meaning is one line, with the unit in brackets where the
/// name does not end in it. The range is not used for bool, string and names.
template <class Config>
struct Field {
  template <class Member>
  Field(std::string_view name_, Member Config::*member, std::string_view meaning_,
        Range range_ = {}, Consequences consequences_ = {})
      : name(name_),
        value_of([member](Config& config) { return value_in(config.*member); }),
        meaning(meaning_),
        range(range_),
        consequences(consequences_) {}
  Field(std::string name_, std::function<Value(Config&)> value_of_, std::string_view meaning_,
        Range range_, Consequences consequences_ = {}, Group group_ = Group::none)
      : name(std::move(name_)),
        value_of(std::move(value_of_)),
        meaning(meaning_),
        range(range_),
        consequences(consequences_),
        group(group_) {}

  std::string name;  ///< "outer.inner" for a member of a member.
  std::function<Value(Config&)> value_of;
  std::string_view meaning;
  Range range;
  Consequences consequences{};
  Group group = Group::none;
};

template <class Config>
using FieldTable = std::vector<Field<Config>>;

/// The table with all its rows in the group that have none yet.
template <class Config>
FieldTable<Config> in_group(Group group, FieldTable<Config> table) {
  for (Field<Config>& row : table) {
    if (row.group == Group::none) row.group = group;
  }
  return table;
}

/// The rows of all tables, in their order.
template <class Config>
FieldTable<Config> joined(std::initializer_list<FieldTable<Config>> tables) {
  FieldTable<Config> all;
  for (const FieldTable<Config>& table : tables) all.insert(all.end(), table.begin(), table.end());
  return all;
}

/// The table with the rows of a member that is a struct itself added, their names behind the
/// prefix.
template <class Config, class Inner>
FieldTable<Config> with_prefixed(FieldTable<Config> table, const std::string& prefix,
                                 Inner Config::*member, const FieldTable<Inner>& inner_table) {
  for (const Field<Inner>& inner : inner_table) {
    table.emplace_back(
        prefix + inner.name,
        [member, value_of = inner.value_of](Config& config) { return value_of(config.*member); },
        inner.meaning, inner.range, inner.consequences, inner.group);
  }
  return table;
}

/// The table with the rows of a member that is a struct itself added: under "name.", as a message
/// of its own in the proto.
template <class Config, class Inner>
FieldTable<Config> with_nested(FieldTable<Config> table, std::string_view name,
                               Inner Config::*member, const FieldTable<Inner>& inner_table) {
  return with_prefixed(std::move(table), std::string(name) + ".", member, inner_table);
}

/// The table with the rows of a member that is a struct itself added, under their own names: a
/// group of settings that the proto does not nest.
template <class Config, class Inner>
FieldTable<Config> with_members_of(FieldTable<Config> table, Inner Config::*member,
                                   const FieldTable<Inner>& inner_table) {
  return with_prefixed(std::move(table), "", member, inner_table);
}

/// A setting of one particular struct.
struct BoundField {
  std::string name;
  Value value;
  std::string_view meaning;
  Range range;
  Consequences consequences{};
  Group group = Group::none;
};

/// All settings of one stage's struct, under the stage's name in Profile.
struct BoundStage {
  std::string_view stage;
  std::vector<BoundField> fields;
};

template <class Config>
std::vector<BoundField> bind_fields(const FieldTable<Config>& table, Config& config) {
  std::vector<BoundField> bound;
  for (const Field<Config>& row : table)
    bound.push_back(
        {row.name, row.value_of(config), row.meaning, row.range, row.consequences, row.group});
  return bound;
}

template <class Config>
BoundStage bind_stage(std::string_view stage, const FieldTable<Config>& table, Config& config) {
  return {stage, bind_fields(table, config)};
}

/// Row for a member that is a vector of structs: a repeated message in the proto, each with the
/// rows of the table.
template <class Config, class Element>
Field<Config> list_of(std::string_view name, std::vector<Element> Config::*member,
                      const FieldTable<Element>& table, std::string_view meaning) {
  const auto value_of = [member, table](Config& config) -> Value {
    std::vector<Element>& elements = config.*member;
    return List{[&elements] { elements.clear(); },
                [&elements, table] { return bind_fields(table, elements.emplace_back()); }};
  };
  return {std::string(name), value_of, meaning, {}};
}

/// "0.02 to 1", "above 0", "0 or more"; empty for any number.
std::string range_in_words(const Range& range);

/// The number as the range check sees it; nothing for what is none.
std::optional<double> number_in(const BoundField& field);

/// "cell_size_m = 7 is outside [0.02, 1]: Edge of a cell." or nothing when the value may be used.
/// NaN never may.
std::optional<std::string> find_fault(const BoundField& field);

/// The first fault of the stage, prefixed by the stage's name.
std::optional<std::string> find_fault(const BoundStage& stage);

}  // namespace slammot::config
