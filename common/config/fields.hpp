#pragma once

#include <cstdint>
#include <functional>
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

inline constexpr Range kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::max()};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::max()};
inline constexpr Range kShare{0.0, 1.0};

struct BoundField;

/// One of several names: an enum with the same numbers in C++ and in the proto.
struct Choice {
  std::function<int()> get;
  std::function<void(int)> set;
};

/// A repeated struct. A list in a text replaces the old content.
struct List {
  std::function<void()> clear;
  std::function<std::vector<BoundField>()> append;  ///< Appends a struct with defaults and returns its bound fields.
};

/// Location of a setting in a configuration struct; valid as long as the struct.
using Value = std::variant<bool*, int*, std::uint32_t*, std::int64_t*, std::uint64_t*, float*, double*, std::string*, Choice, List>;

template <class Member>
Value value_in(Member& member) {
  if constexpr (std::is_enum_v<Member>) {
    return Choice{[&member] { return static_cast<int>(member); }, [&member](int number) { member = static_cast<Member>(number); }};
  } else {
    return &member;
  }
}

/// One row of a stage's field table: {"name as in slammot.proto", pointer to member, "meaning", range}. The meaning is one
/// line, with the unit where the name does not end in it. The range is not used for bool, string and names.
template <class Config>
struct Field {
  template <class Member>
  Field(std::string_view name_, Member Config::*member, std::string_view meaning_, Range range_ = {})
      : name(name_), value_of([member](Config& config) { return value_in(config.*member); }), meaning(meaning_), range(range_) {}
  Field(std::string name_, std::function<Value(Config&)> value_of_, std::string_view meaning_, Range range_)
      : name(std::move(name_)), value_of(std::move(value_of_)), meaning(meaning_), range(range_) {}

  std::string name;  ///< "outer.inner" for a member of a member.
  std::function<Value(Config&)> value_of;
  std::string_view meaning;
  Range range;
};

template <class Config>
using FieldTable = std::vector<Field<Config>>;

/// The table extended by the rows of a member struct: under "name.", a separate message in the proto.
template <class Config, class Inner>
FieldTable<Config> with_nested(FieldTable<Config> table, std::string_view name, Inner Config::*member,
                               const FieldTable<Inner>& inner_table) {
  for (const Field<Inner>& inner : inner_table) {
    table.emplace_back(std::string(name) + "." + inner.name,
                       [member, value_of = inner.value_of](Config& config) { return value_of(config.*member); },
                       inner.meaning, inner.range);
  }
  return table;
}

/// A setting of one particular struct.
struct BoundField {
  std::string name;
  Value value;
  std::string_view meaning;
  Range range;
};

/// All settings of one stage's struct, under the stage's name in Profile.
struct BoundStage {
  std::string_view stage;
  std::vector<BoundField> fields;
};

template <class Config>
std::vector<BoundField> bind_fields(const FieldTable<Config>& table, Config& config) {
  std::vector<BoundField> bound;
  for (const Field<Config>& row : table) bound.push_back({row.name, row.value_of(config), row.meaning, row.range});
  return bound;
}

template <class Config>
BoundStage bind_stage(std::string_view stage, const FieldTable<Config>& table, Config& config) {
  return {stage, bind_fields(table, config)};
}

/// Row for a member that is a vector of structs: a repeated message in the proto, each with the rows of the table.
template <class Config, class Element>
Field<Config> list_of(std::string_view name, std::vector<Element> Config::*member, const FieldTable<Element>& table, std::string_view meaning) {
  const auto value_of = [member, table](Config& config) -> Value {
    std::vector<Element>& elements = config.*member;
    return List{[&elements] { elements.clear(); }, [&elements, table] { return bind_fields(table, elements.emplace_back()); }};
  };
  return {std::string(name), value_of, meaning, {}};
}

/// The number for the range check; none if the value is not numeric.
std::optional<double> number_in(const BoundField& field);

/// "cell_size_m = 7 is outside [0.02, 1]: Edge of a cell." or nothing when the value may be used. NaN never may.
std::optional<std::string> find_fault(const BoundField& field);

/// The first fault of the stage, prefixed by the stage's name.
std::optional<std::string> find_fault(const BoundStage& stage);

}  // namespace slammot::config
