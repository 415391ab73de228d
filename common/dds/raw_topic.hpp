#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "common/dds/participant.hpp"
#include "common/dds/topic_table.hpp"
#include "common/dds/type_model.hpp"

struct ddsi_typeinfo;

namespace slammot::dds {

/// A topic whose type was not compiled in.
class RawTopic {
 public:
  /// Of a writer's type information. What it consists of is asked of the writer's participant
  /// unless it is known here, for at most `patience` each. Null: not known by then.
  static std::shared_ptr<const RawTopic> resolve(const Participant& participant,
                                                 const std::string& name,
                                                 const std::string& type_name,
                                                 const ddsi_typeinfo& information,
                                                 std::chrono::nanoseconds patience);
  /// Of a topic whose type is compiled in.
  static std::shared_ptr<const RawTopic> of_table(const TopicInfo& topic);
  /// Of a type as type() gave it. Null: the description is damaged.
  static std::shared_ptr<const RawTopic> of_type(const std::string& name, const RawType& type);

  /// Without a compiled type, and with a flow that is not the topic's: its QoS follows what writers
  /// offer.
  const TopicInfo& info() const { return info_; }
  const RawType& type() const { return type_; }
  const TypeModel& model() const { return model_; }

 private:
  RawTopic(std::string name, RawType type, TypeModel model);

  std::string name_;
  RawType type_;
  TypeModel model_;
  TopicInfo info_;
};

}  // namespace slammot::dds
