#include "common/app/stop_signal.hpp"

#include <csignal>
#include <future>

#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/dds.hpp"

namespace slammot::app {
namespace {

TEST(StopSignal, CallsStopInsteadOfEndingTheProcess) {
  for (const int signal : {SIGTERM, SIGINT}) {
    std::promise<void> stopped;
    const StopSignal stop_signal([&] { stopped.set_value(); });
    ::kill(::getpid(), signal);
    EXPECT_EQ(stopped.get_future().wait_for(slammot::testing::kForever), std::future_status::ready);
  }
}

TEST(StopSignal, EndsTheProcessAtTheSecondOne) {
  EXPECT_EXIT(
      {
        std::promise<void> stopped;
        const StopSignal stop_signal([&] { stopped.set_value(); });
        ::kill(::getpid(), SIGTERM);
        stopped.get_future().wait();
        ::kill(::getpid(), SIGTERM);
        for (;;) ::pause();
      },
      ::testing::ExitedWithCode(128 + SIGTERM), "");
}

TEST(StopSignal, IsGoneWithoutASignal) {
  const StopSignal stop_signal([] { FAIL(); });
}

}  // namespace
}  // namespace slammot::app
