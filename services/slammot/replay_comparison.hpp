#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/dds/cdr_walk.hpp"

namespace slammot {

/// How far two values of a field may be apart: |a - b| <= tolerance * max(1, |a|, |b|). Integers,
/// enums and texts must be equal.
struct ReplayTolerances {
  double general = 1e-9;
  std::map<std::string, double> of_field = {};  ///< By the field's path or its end: "existence".

  double of(const std::string& field) const;
};

/// A recorded sample, or the one that was published in its place.
struct ReplayedSample {
  const std::string* topic = nullptr;
  const dds::TypeModel* model = nullptr;
  std::optional<std::int64_t> stamp_ns;  ///< As the sample says it.
  double recorded_at_s = 0.0;            ///< Since the recording's start.
  std::span<const std::uint8_t> cdr;
};

struct ReplayDifference {
  std::string topic;
  std::optional<std::int64_t> stamp_ns;
  double recorded_at_s = 0.0;
  std::string field;     ///< "objects[3].existence"; empty: the whole sample.
  std::string recorded;  ///< Values as text.
  std::string replayed;
};

/// Of a field in all samples and all elements of lists: "objects[].existence".
struct FieldDifferences {
  std::uint64_t values = 0;  ///< That differ.
  double largest = 0.0;      ///< Of numbers.
};

struct TopicDifferences {
  std::uint64_t compared = 0;
  std::uint64_t different = 0;
  std::uint64_t missing = 0;     ///< Recorded, and not published now.
  std::uint64_t additional = 0;  ///< Published now, and not recorded.
  std::map<std::string, FieldDifferences> fields = {};
};

/// Differences between what a service published and what it publishes now.
class ReplayComparison {
 public:
  explicit ReplayComparison(ReplayTolerances tolerances) : tolerances_(std::move(tolerances)) {}

  /// Samples of one topic, instance and stamp.
  void compare(const ReplayedSample& recorded, std::span<const std::uint8_t> replayed);
  void note_missing(const ReplayedSample& recorded);
  void note_additional(const ReplayedSample& replayed);

  bool has_difference() const { return first_.has_value(); }
  const std::optional<ReplayDifference>& first() const { return first_; }
  const std::map<std::string, TopicDifferences>& topics() const { return topics_; }

 private:
  using Values = std::vector<dds::CdrValue>;
  bool differ(const dds::CdrValue& a, const dds::CdrValue& b) const;
  void note(const ReplayedSample& sample, const dds::CdrValue& recorded,
            const dds::CdrValue& replayed);
  void note_first(const ReplayedSample& sample, std::string field, std::string recorded,
                  std::string replayed);

  ReplayTolerances tolerances_;
  std::optional<ReplayDifference> first_;
  std::map<std::string, TopicDifferences> topics_;
};

/// "objects[].existence" of "objects[3].existence".
std::string without_indices(const std::string& path);

}  // namespace slammot
