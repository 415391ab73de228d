#include "common/app/health.hpp"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/app/service_context.hpp"
#include "tests/support/dds.hpp"

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

struct HealthOnTheBus : ::testing::Test {
  slammot::testing::PrivateBus bus;
  HealthQuestion question{{"map-store"}, "car", "", bus.domain_id, slammot::testing::kForever,
                          bus.config};

  std::unique_ptr<ServiceContext> start(const std::string& service = "map_store") const {
    ServiceOptions options;
    options.vehicle_id = "car";
    options.domain_id = bus.domain_id;
    options.dds_config = bus.config;
    return std::make_unique<ServiceContext>(service, options);
  }

  std::vector<Health> ask_while_it_runs(ServiceContext& context) const {
    std::thread running([&] { context.run(); });
    auto healths = check_health(question);
    context.stop();
    running.join();
    return healths;
  }
};

TEST_F(HealthOnTheBus, IsGoodWhileTheServiceRuns) {
  const auto context = start();
  const auto healths = ask_while_it_runs(*context);
  ASSERT_EQ(healths.size(), 1U);
  EXPECT_EQ(healths[0].verdict, Verdict::kGood);
  EXPECT_EQ(healths[0].name.service, "map_store");
  EXPECT_EQ(healths[0].text, "running");
}

TEST_F(HealthOnTheBus, IsDegradedAndSaysWhatARunningServiceMisses) {
  const auto context = start();
  context->status().set_trouble("database", "database is locked");
  const auto healths = ask_while_it_runs(*context);
  ASSERT_EQ(healths.size(), 1U);
  EXPECT_EQ(verdict_of(healths), Verdict::kDegraded);
  EXPECT_EQ(healths[0].text, "degraded: database is locked");
}

TEST_F(HealthOnTheBus, IsDownWhereThereIsNoSuchService) {
  question.patience = 300ms;
  const auto healths = check_health(question);
  EXPECT_EQ(verdict_of(healths), Verdict::kDown);
  EXPECT_THAT(healths.at(0).text, ::testing::StartsWith("no heartbeat within"));
}

TEST_F(HealthOnTheBus, IsDownForAnotherVehicle) {
  const auto context = start();
  question.vehicle_id = "bus";
  question.patience = 500ms;
  EXPECT_EQ(verdict_of(ask_while_it_runs(*context)), Verdict::kDown);
}

TEST_F(HealthOnTheBus, IsDownIfOneOfSeveralIs) {
  const auto context = start();
  question.services.emplace_back("detection");
  question.patience = 1500ms;
  const auto healths = ask_while_it_runs(*context);
  ASSERT_EQ(healths.size(), 2U);
  EXPECT_EQ(verdict_of(healths), Verdict::kDown);
}

TEST_F(HealthOnTheBus, ListsAllThatItHearsWhereNothingIsAskedFor) {
  const auto context = start(), other = start("detection");
  question.services.clear();
  question.patience = 1500ms;
  std::thread running([&] { other->run(); });
  const auto healths = ask_while_it_runs(*context);
  other->stop();
  running.join();
  ASSERT_EQ(healths.size(), 2U);
  EXPECT_EQ(healths[0].name.service, "detection");
  EXPECT_EQ(healths[1].name.service, "map_store");
}

TEST_F(HealthOnTheBus, DoesNotTakeAStandbyForTheService) {
  const auto context = start();
  context->status().set_starting(true);
  context->set_role({.stands_by = true, .term = 0});
  question.patience = 1500ms;
  const auto healths = ask_while_it_runs(*context);
  ASSERT_EQ(healths.size(), 1U);
  EXPECT_TRUE(healths[0].stands_by);
  EXPECT_EQ(verdict_of(healths), Verdict::kDown);
}

}  // namespace
}  // namespace slammot::app
