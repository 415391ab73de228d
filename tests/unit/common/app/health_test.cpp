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
  HealthQuestion question{"map-store", "car", "", bus.domain_id, slammot::testing::kForever,
                          bus.config};

  std::unique_ptr<ServiceContext> start() const {
    ServiceOptions options;
    options.vehicle_id = "car";
    options.domain_id = bus.domain_id;
    options.dds_config = bus.config;
    return std::make_unique<ServiceContext>("map_store", options);
  }

  Health ask_while_it_runs(ServiceContext& context) const {
    std::thread running([&] { context.run(); });
    const Health health = check_health(question);
    context.stop();
    running.join();
    return health;
  }
};

TEST_F(HealthOnTheBus, IsGoodWhileTheServiceRuns) {
  const auto context = start();
  const Health health = ask_while_it_runs(*context);
  EXPECT_TRUE(health.is_healthy);
  EXPECT_EQ(health.text, "map_store: running");
}

TEST_F(HealthOnTheBus, SaysWhatARunningServiceMisses) {
  const auto context = start();
  context->status().set_trouble("database", "database is locked");
  const Health health = ask_while_it_runs(*context);
  EXPECT_TRUE(health.is_healthy);
  EXPECT_EQ(health.text, "map_store: degraded, database is locked");
}

TEST_F(HealthOnTheBus, IsBadWhereThereIsNoSuchService) {
  question.patience = 300ms;
  EXPECT_FALSE(check_health(question).is_healthy);
  EXPECT_THAT(check_health(question).text, ::testing::StartsWith("map_store: no heartbeat within"));
}

TEST_F(HealthOnTheBus, IsBadForAnotherVehicle) {
  const auto context = start();
  question.vehicle_id = "bus";
  question.patience = 500ms;
  EXPECT_FALSE(ask_while_it_runs(*context).is_healthy);
}

}  // namespace
}  // namespace slammot::app
