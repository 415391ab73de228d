#include "services/slammot/profile.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/print.hpp"
#include "common/config/profiles.hpp"

namespace slammot {
namespace {

TEST(Profile, TablesAndProtoAgreeFieldByField) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile)) {
    EXPECT_THAT(config::differences_from_proto(stage), ::testing::IsEmpty());
  }
}

TEST(Profile, HasEveryStageThatTheProtoHas) {
  Profile profile;
  std::vector<std::string> bound = {"example"};  // the configuration's own tests use it
  for (const config::BoundStage& stage : bind_stages(profile)) bound.emplace_back(stage.stage);
  EXPECT_THAT(bound, ::testing::UnorderedElementsAreArray(config::stages_in_proto()));
}

TEST(Profile, DefaultsAreWithinTheirRanges) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile)) EXPECT_EQ(config::find_fault(stage), std::nullopt);
}

TEST(Profile, ExplainsEverySetting) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile)) {
    for (const config::BoundField& field : stage.fields) EXPECT_THAT(field.meaning, ::testing::EndsWith(".")) << field.name;
  }
}

TEST(Profile, FromAnEmptyFileEqualsTheDefaults) {
  Profile defaults;
  Profile from_empty;
  ASSERT_FALSE(config::overlay_text("", "empty", bind_stages(from_empty)));
  EXPECT_EQ(config::print(bind_stages(from_empty)), config::print(bind_stages(defaults)));
}

TEST(Profile, PrintedReadsBackAsItself) {
  Profile profile;
  profile.localization.map.cell_size_m = 0.1;
  profile.ingest.scanner_id = "rear";
  const std::string printed = config::print(bind_stages(profile));
  Profile read_back;
  ASSERT_FALSE(config::overlay_text(printed, "printed", bind_stages(read_back)));
  EXPECT_EQ(config::print(bind_stages(read_back)), printed);
}

TEST(Profile, EveryShippedOneLoads) {
  ASSERT_THAT(config::profile_names(), ::testing::IsSupersetOf({"indoor", "urban"}));
  for (const std::string& name : config::profile_names()) {
    Profile profile;
    const auto fault = config::overlay_file(config::find_profile(name).value(), bind_stages(profile));
    EXPECT_FALSE(fault) << fault->text();
  }
}

}  // namespace
}  // namespace slammot
