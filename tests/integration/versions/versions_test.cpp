#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/reader.hpp"
#include "common/wire/sensor.hpp"
#include "tests/support/dds.hpp"

extern char** environ;

namespace slammot::dds {
namespace {

using slammot::testing::kForever;
using slammot::testing::PrivateBus;
using ::testing::HasSubstr;

/// A process of another version that publishes odometry.
class Neighbour {
 public:
  Neighbour(const char* program, const PrivateBus& bus) {
    std::string name = program, domain = std::to_string(bus.domain_id), config = bus.config;
    char* arguments[] = {name.data(), domain.data(), config.data(), nullptr};
    if (posix_spawn(&process_, program, nullptr, nullptr, arguments, environ) != 0) std::abort();
  }
  ~Neighbour() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }

 private:
  pid_t process_ = 0;
};

struct Versions : ::testing::Test {
  PrivateBus bus;
  Participant participant = bus.join();
  Reader<slammot_Odometry> reader{participant, topics::kOdometry};

  /// The first sample that comes, as this version understands it.
  std::optional<sensing::Odometry> first() {
    std::optional<sensing::Odometry> odometry;
    if (!reader.wait_for_writers(1, kForever)) return odometry;
    for (const auto end = std::chrono::steady_clock::now() + kForever;
         !odometry && std::chrono::steady_clock::now() < end;) {
      reader.take_each([&](const slammot_Odometry& sample) {
        if (auto decoded = wire::decode(sample)) odometry = *decoded;
      });
    }
    return odometry;
  }
};

TEST_F(Versions, ANeighbourWithoutOurLastMemberIsUnderstood) {
  const Neighbour neighbour(OLDER_NEIGHBOUR, bus);
  const auto odometry = first();
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->stamp_ns, 1'500'000'000);
  EXPECT_EQ(odometry->wheel_from_base.x_m, 0.0);
}

TEST_F(Versions, ANeighbourWithAMemberMoreIsUnderstood) {
  const Neighbour neighbour(NEWER_NEIGHBOUR, bus);
  const auto odometry = first();
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->stamp_ns, 1'500'000'000);
}

TEST_F(Versions, ANeighbourThatChangedAMemberIsRefusedWithAClearWord) {
  const Neighbour neighbour(OTHER_NEIGHBOUR, bus);
  ASSERT_TRUE(reader.wait_for_mismatch(kForever));
  EXPECT_EQ(reader.mismatch()->policy, "type");
  EXPECT_THAT(
      reader.mismatch()->text(),
      HasSubstr("slammot/odometry: another participant's version of the type is incompatible"));
  EXPECT_EQ(reader.take_each([](const slammot_Odometry&) {}), 0U);
}

}  // namespace
}  // namespace slammot::dds
