#include "common/app/standby.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/dds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

using namespace std::chrono_literals;
using slammot::testing::kForever;

/// A process of a service, as far as others can tell, in a thread of its own.
class Process {
 public:
  Process(const slammot::testing::PrivateBus& bus, const std::string& instance,
          const std::filesystem::path& lock_file)
      : lock_(lock_file), context_("localization", options(bus, instance)) {
    thread_ = std::thread([this] {
      Standby standby(context_, &lock_);
      if (!standby.wait_until_it_leads([this](ServiceContext&) { ++rehearsals_; })) return;
      leads_ = true;
      most_leading = std::max<int>(most_leading, ++leading);
      context_.run([this] {
        --leading;
        leads_ = false;
        lock_.release();
      });
    });
  }
  ~Process() { stop(); }
  void stop() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
  }
  bool leads() const { return leads_; }
  int rehearsals() const { return rehearsals_; }

  static inline std::atomic<int> leading = 0;  ///< Of all.
  static inline std::atomic<int> most_leading = 0;

 private:
  static ServiceOptions options(const slammot::testing::PrivateBus& bus,
                                const std::string& instance) {
    ServiceOptions options;
    options.vehicle_id = "car";
    options.instance = instance;
    options.domain_id = bus.domain_id;
    options.dds_config = bus.config;
    return options;
  }

  StateLock lock_;
  ServiceContext context_;
  std::atomic<bool> leads_ = false;
  std::atomic<int> rehearsals_ = 0;
  std::thread thread_;
};

struct StandbyOnTheBus : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  slammot::testing::PrivateBus bus;
  dds::Participant neighbour = bus.join();
  dds::WaitSet wait_set{neighbour};
  dds::Reader<slammot_ServiceStatus> statuses{neighbour, dds::topics::kStatus};
  std::set<std::string> explanations;

  StandbyOnTheBus() {
    wait_set.on_data(statuses, [this] {
      statuses.take_each([this](const auto& status) { explanations.insert(status.explanation); });
    });
  }
  bool comes_to(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + kForever;
    while (!condition() && std::chrono::steady_clock::now() < end) wait_set.wait(5ms);
    return condition();
  }
  auto is_told(const std::string& text) {
    return [this, text] {
      return std::ranges::any_of(
          explanations, [&](const auto& one) { return one.find(text) != std::string::npos; });
    };
  }
};

TEST_F(StandbyOnTheBus, WaitsWhileAnotherOneLeadsAndTakesOverWhenItStops) {
  Process first(bus, "one", folder / "one.lock");
  ASSERT_TRUE(comes_to([&] { return first.leads(); }));
  Process second(bus, "two", folder / "two.lock");
  EXPECT_TRUE(comes_to(
      is_told("stands by: process " + std::to_string(::getpid()) + " (instance one) leads")));
  EXPECT_FALSE(second.leads());
  first.stop();
  EXPECT_TRUE(comes_to([&] { return second.leads(); }));
  EXPECT_EQ(first.rehearsals(), 0) << "it never stood by";
  EXPECT_EQ(second.rehearsals(), 1);
}

TEST_F(StandbyOnTheBus, WaitsForStateThatASilentProcessHolds) {
  StateLock hung(folder / "state.lock");
  ASSERT_EQ(hung.try_lock(), StateLock::Outcome::kLocked);
  Process process(bus, "main", folder / "state.lock");
  EXPECT_TRUE(comes_to(is_told("state.lock is in use by process")));
  EXPECT_FALSE(process.leads());
}

TEST_F(StandbyOnTheBus, NeverHasTwoLeadersOfOneState) {
  Process::most_leading = 0;
  std::vector<std::unique_ptr<Process>> all;
  const auto start = [&](int number) {
    return std::make_unique<Process>(bus, "copy" + std::to_string(number), folder / "state.lock");
  };
  for (int number = 0; number < 4; ++number) all.push_back(start(number));
  for (int number = 4; number < 9; ++number) {
    const auto leads = [](const auto& process) { return process->leads(); };
    ASSERT_TRUE(comes_to([&] { return std::ranges::any_of(all, leads); })) << number;
    const auto leader = std::ranges::find_if(all, leads);
    *leader = nullptr;  // ends it first
    *leader = start(number);
  }
  EXPECT_EQ(Process::most_leading, 1);
}

TEST_F(StandbyOnTheBus, EndsWhenItIsStopped) {
  Process first(bus, "one", folder / "one.lock");
  ASSERT_TRUE(comes_to([&] { return first.leads(); }));
  Process second(bus, "two", folder / "two.lock");
  second.stop();
  EXPECT_FALSE(second.leads());
}

}  // namespace
}  // namespace slammot::app
