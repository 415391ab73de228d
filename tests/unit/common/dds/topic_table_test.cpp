#include "common/dds/topic_table.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::dds {
namespace {

using ::testing::StartsWith;

TEST(TopicTable, HasEachNameOnce) {
  std::set<std::string_view> names;
  for (const TopicInfo* topic : topic_table())
    EXPECT_TRUE(names.insert(topic->name).second) << topic->name;
}

TEST(TopicTable, NamesTopicsAndTypesAfterTheProject) {
  for (const TopicInfo* topic : topic_table()) {
    EXPECT_THAT(std::string(topic->name), StartsWith("slammot/"));
    EXPECT_THAT(std::string(topic->type_name()), StartsWith("slammot::"));
  }
}

TEST(TopicTable, KeysEverySampleByItsVehicleFirst) {
  for (const TopicInfo* topic : topic_table()) {
    ASSERT_GE(topic->type->m_nkeys, 1U) << topic->name;
    EXPECT_STREQ(topic->type->m_keys[0].m_name, "vehicle_id") << topic->name;
  }
}

TEST(TopicTable, CarriesTypeInformationForTheStockTools) {
  for (const TopicInfo* topic : topic_table())
    EXPECT_GT(topic->type->type_information.sz, 0U) << topic->name;
}

TEST(TopicTable, NamesAPublisherOfEachTopic) {
  for (const TopicInfo* topic : topic_table())
    EXPECT_FALSE(topic->publishers.empty()) << topic->name;
}

TEST(TopicTable, TakesNamesOfPublishersAsWholeWords) {
  EXPECT_TRUE(may_publish("ingest", topics::kLaserScan));
  EXPECT_TRUE(may_publish("simulator", topics::kLaserScan));
  EXPECT_FALSE(may_publish("sim", topics::kLaserScan));
  EXPECT_FALSE(may_publish("", topics::kLaserScan));
  EXPECT_FALSE(may_publish("ingest simulator", topics::kLaserScan));
  EXPECT_TRUE(may_publish("anything", topics::kHeartbeat));
}

TEST(TopicTable, FindsItsRowsByName) {
  for (const TopicInfo* topic : topic_table()) EXPECT_EQ(find_topic(topic->name), topic);
  EXPECT_EQ(find_topic("slammot/nothing"), nullptr);
}

}  // namespace
}  // namespace slammot::dds
