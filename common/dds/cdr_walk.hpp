#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/dds/type_model.hpp"

namespace slammot::dds {

/// A value of a sample that has no parts.
struct CdrValue {
  std::string path;  ///< "objects[3].position_in_odom_m.x"
  TypeKind kind = TypeKind::kUnknown;
  double number = 0.0;       ///< Of numbers, enums, booleans.
  std::int64_t integer = 0;  ///< Of those that are no floating-point numbers; exact.
  std::string text;          ///< Of a string.

  /// For a message to the user.
  std::string to_text() const;
};

/// Calls `visit` for each value of a serialized sample, in the order of its members (OMG DDS-XTypes
/// 1.3, 7.4: versions 1 and 2 of CDR). False where the bytes or the model end before the sample
/// does, and for what this does not read: mutable types, maps.
bool for_each_value(const TypeModel& model, std::span<const std::uint8_t> cdr,
                    const std::function<void(const CdrValue&)>& visit);

/// Whether the topic's samples have keys.
bool is_keyed(const TypeModel& model);

/// The bytes of the sample's keys into `key`: those of two samples are the same if both are of one
/// instance. False as for_each_value().
bool copy_key(const TypeModel& model, std::span<const std::uint8_t> cdr,
              std::vector<std::uint8_t>& key);

}  // namespace slammot::dds
