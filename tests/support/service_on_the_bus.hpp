#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "common/app/service_context.hpp"
#include "tests/support/dds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::testing {

/// A service, of vehicle "car", on a bus of its own with a neighbour; both in the test's thread.
class ServiceOnTheBus : public ::testing::Test {
 protected:
  template <typename Service>
  void start(const std::string& name, const typename Service::Settings& settings = {}) {
    app::ServiceOptions options;
    options.vehicle_id = "car";
    options.domain_id = bus_.domain_id;
    options.dds_config = bus_.config;
    options.state_dir = folder_.path();
    context_ = std::make_unique<app::ServiceContext>(name, options);
    service_ = std::make_shared<Service>(*context_, settings);
  }

  /// Its end leaves nothing behind but files: as a kill does.
  void stop() {
    service_.reset();
    context_.reset();
  }

  /// Lets the service work until the condition holds. The condition is asked every few
  /// milliseconds.
  ::testing::AssertionResult comes_to(const std::function<bool()>& condition) {
    bool held = false;
    const auto end = std::chrono::steady_clock::now() + kForever;
    while (!held && std::chrono::steady_clock::now() < end) {
      context_->run_for(std::chrono::milliseconds(5));
      held = condition();
    }
    return held ? ::testing::AssertionSuccess() : ::testing::AssertionFailure() << "did not happen";
  }

  TemporaryFolder folder_;
  PrivateBus bus_;
  dds::Participant neighbour_ = bus_.join();
  std::unique_ptr<app::ServiceContext> context_;
  std::shared_ptr<void> service_;
};

}  // namespace slammot::testing
