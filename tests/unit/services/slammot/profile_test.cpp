#include "services/slammot/profile.hpp"

#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/print.hpp"
#include "common/config/profiles.hpp"

namespace slammot {
namespace {

/// Converts to any type, to count the members of an aggregate.
struct Anything {
  template <class Type>
  operator Type() const;  // never called, not defined
};

template <class Struct, std::size_t... kIndices>
constexpr bool takes(std::index_sequence<kIndices...>) {
  return requires { Struct{(static_cast<void>(kIndices), Anything{})...}; };
}

/// Number of members of a plain struct.
template <class Struct, std::size_t kCount = 100>
constexpr std::size_t members() {
  if constexpr (takes<Struct>(std::make_index_sequence<kCount>())) {
    return kCount;
  } else {
    return members<Struct, kCount - 1>();
  }
}

/// Number of settings and nested messages directly under a prefix ("" or "map.") of a stage.
std::size_t settings_under(const config::BoundStage& stage, const std::string& prefix) {
  std::set<std::string> names;
  for (const config::BoundField& field : stage.fields) {
    if (!field.name.starts_with(prefix)) continue;
    const std::string rest = field.name.substr(prefix.size());
    names.insert(rest.substr(0, rest.find('.')));
  }
  return names.size();
}

TEST(Profile, HasASettingForEveryMemberWhereAllAreForUsers) {
  Profile profile;
  std::map<std::string, config::BoundStage> stages;
  for (config::BoundStage& stage : bind_stages(profile))
    stages[std::string(stage.stage)] = std::move(stage);
  EXPECT_EQ(settings_under(stages["tracking"], ""),
            members<tracking::SensorNoise>() + members<tracking::MotionConfig>() +
                members<tracking::AssociationConfig>() + members<tracking::ExtentConfig>() +
                members<tracking::ExistenceConfig>() + members<tracking::PublicationConfig>());
  EXPECT_EQ(settings_under(stages["implementations"], ""), members<ImplementationChoice>());
}

TEST(Profile, ExplainsTheEffectOfEveryNumber) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile)) {
    if (stage.stage == "implementations") continue;  // it has no numbers
    for (const config::BoundField& field : stage.fields) {
      EXPECT_NE(field.group, config::Group::none) << field.name;
      if (!config::number_in(field)) continue;
      EXPECT_THAT(field.consequences.too_small, ::testing::EndsWith(".")) << field.name;
      EXPECT_THAT(field.consequences.too_large, ::testing::EndsWith(".")) << field.name;
    }
  }
}

TEST(Profile, TablesAndProtoAgreeFieldByField) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile)) {
    EXPECT_THAT(config::differences_from_proto(stage), ::testing::IsEmpty());
  }
}

TEST(Profile, HasEveryStageThatTheProtoHas) {
  Profile profile;
  std::vector<std::string> bound = {"example"};  // used by the tests of the configuration
  for (const config::BoundStage& stage : bind_stages(profile)) bound.emplace_back(stage.stage);
  EXPECT_THAT(bound, ::testing::UnorderedElementsAreArray(config::stages_in_proto()));
}

TEST(Profile, DefaultsAreWithinTheirRanges) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile))
    EXPECT_EQ(config::find_fault(stage), std::nullopt);
}

TEST(Profile, ExplainsEverySetting) {
  Profile profile;
  for (const config::BoundStage& stage : bind_stages(profile)) {
    for (const config::BoundField& field : stage.fields)
      EXPECT_THAT(field.meaning, ::testing::EndsWith(".")) << field.name;
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
    const auto fault =
        config::overlay_file(config::find_profile(name).value(), bind_stages(profile));
    EXPECT_FALSE(fault) << fault->text();
  }
}

}  // namespace
}  // namespace slammot
