#include "common/dds/cdr_walk.hpp"

#include <map>
#include <random>

#include <gtest/gtest.h>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>

#include "common/dds/topic_table.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using slammot::testing::assign;

template <typename Sample>
TypeModel model_of_topic(const Topic<Sample>& topic) {
  const auto& information = topic.type->type_information;
  const auto& mapping = topic.type->type_mapping;
  return model_of({std::string(topic.type_name()),
                   {information.data, information.data + information.sz},
                   {mapping.data, mapping.data + mapping.sz}})
      .value();
}

/// As the library serializes it: version 2 of CDR, little endian, appendable.
template <typename Sample>
std::vector<std::uint8_t> serialized(const Topic<Sample>& topic, const Sample& sample) {
  dds_ostream_t stream;
  dds_ostream_init(&stream, 0, CDR_ENC_VERSION_2);
  dds_stream_write(&stream, reinterpret_cast<const char*>(&sample), topic.type->m_ops);
  std::vector<std::uint8_t> bytes = {0, 9, 0, 0};
  bytes.insert(bytes.end(), stream.m_buffer, stream.m_buffer + stream.m_index);
  dds_ostream_fini(&stream);
  return bytes;
}

TEST(CdrWalk, FindsEveryValueWithItsPath) {
  slammot_ScanLabels sample{};
  assign(sample.vehicle_id, "car");
  assign(sample.scanner_id, "front");
  sample.stamp_ns = -5;
  sample.sequence_number = 7;
  sample.scan_published_ns = 9;
  std::vector<slammot_PointLabel> labels = {static_cast<slammot_PointLabel>(1),
                                            static_cast<slammot_PointLabel>(2)};
  sample.labels._buffer = labels.data();
  sample.labels._length = sample.labels._maximum = 2;
  std::vector<slammot_RestoredPoints> restored = {{3, 2}};
  sample.restored_scans._buffer = restored.data();
  sample.restored_scans._length = sample.restored_scans._maximum = 1;
  std::vector<std::uint16_t> beams = {11, 12};
  sample.restored_beams._buffer = beams.data();
  sample.restored_beams._length = sample.restored_beams._maximum = 2;
  std::map<std::string, std::string> values;
  ASSERT_TRUE(for_each_value(model_of_topic(topics::kScanLabels),
                             serialized(topics::kScanLabels, sample),
                             [&](const CdrValue& value) { values[value.path] = value.to_text(); }));
  EXPECT_EQ(values, (std::map<std::string, std::string>{{"vehicle_id", "\"car\""},
                                                        {"scanner_id", "\"front\""},
                                                        {"stamp_ns", "-5"},
                                                        {"sequence_number", "7"},
                                                        {"labels.length", "2"},
                                                        {"labels[0]", "1"},
                                                        {"labels[1]", "2"},
                                                        {"restored_scans.length", "1"},
                                                        {"restored_scans[0].sequence_number", "3"},
                                                        {"restored_scans[0].beam_count", "2"},
                                                        {"restored_beams.length", "2"},
                                                        {"restored_beams[0]", "11"},
                                                        {"restored_beams[1]", "12"},
                                                        {"scan_published_ns", "9"}}));
}

TEST(CdrWalk, KeysTellInstancesApartAndNothingElseDoes) {
  const TypeModel model = model_of_topic(topics::kConstraint);
  const auto key_of = [&](std::uint32_t from, double score) {
    slammot_Constraint sample{};
    assign(sample.vehicle_id, "car");
    sample.from_submap_id = from;
    sample.squared_error = score;
    std::vector<std::uint8_t> key;
    EXPECT_TRUE(copy_key(model, serialized(topics::kConstraint, sample), key));
    return key;
  };
  EXPECT_EQ(key_of(1, 0.5), key_of(1, 0.7));
  EXPECT_NE(key_of(1, 0.5), key_of(2, 0.5));
}

TEST(CdrWalk, BytesThatEndTooEarlyAreRefused) {
  slammot_TrackedObjects sample{};
  assign(sample.vehicle_id, "car");
  std::vector<slammot_TrackedObject> objects(2);
  sample.objects._buffer = objects.data();
  sample.objects._length = sample.objects._maximum = 2;
  const TypeModel model = model_of_topic(topics::kTrackedObjects);
  const auto whole = serialized(topics::kTrackedObjects, sample);
  const auto ignore = [](const CdrValue&) {};
  ASSERT_TRUE(for_each_value(model, whole, ignore));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(for_each_value(model, std::span(whole).first(size), ignore)) << size;
}

TEST(CdrWalk, ChangedBytesNeverReachBeyondTheSample) {
  slammot_TrackedObjects sample{};
  assign(sample.vehicle_id, "car");
  std::vector<slammot_TrackedObject> objects(3);
  sample.objects._buffer = objects.data();
  sample.objects._length = sample.objects._maximum = 3;
  const TypeModel model = model_of_topic(topics::kTrackedObjects);
  const auto whole = serialized(topics::kTrackedObjects, sample);
  std::mt19937 random(5);  // NOLINT(cert-msc51-cpp): the same ones each time
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    auto changed = whole;
    changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    refused += for_each_value(model, changed, [](const CdrValue&) {}) ? 0 : 1;
    std::vector<std::uint8_t> key;
    copy_key(model, changed, key);
    EXPECT_LE(key.size(), changed.size());
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace slammot::dds
