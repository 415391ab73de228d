#include "common/dds/participant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/dds/reader.hpp"
#include "common/dds/writer.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using slammot::testing::kForever;
using slammot::testing::PrivateBus;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string reason_of_failure(const ParticipantOptions& options) {
  try {
    const Participant participant(options);
  } catch (const StartupError& error) { return error.what(); }
  return "";
}

std::string config_with(const std::string& general) {
  return "<CycloneDDS><Domain><General>" + general + "</General></Domain></CycloneDDS>";
}

TEST(Participant, SaysWhichInterfaceIsMissing) {
  const std::string config =
      config_with("<Interfaces><NetworkInterface name=\"nope0\"/></Interfaces>");
  EXPECT_THAT(
      reason_of_failure({.domain_id = 3, .name = "", .config = config}),
      AllOf(HasSubstr("DDS domain 3"), HasSubstr("nope0: does not match an available interface"),
            Not(HasSubstr("\n"))));
}

TEST(Participant, SaysWhatIsWrongInItsConfiguration) {
  EXPECT_THAT(reason_of_failure({.domain_id = 3, .name = "", .config = config_with("<Nonsense/>")}),
              HasSubstr("Nonsense: unknown element"));
}

TEST(Participant, SaysWhichConfigurationFileIsMissing) {
  EXPECT_THAT(reason_of_failure({.domain_id = 3, .name = "", .config = "file:///nowhere/dds.xml"}),
              HasSubstr("can't open configuration file file:///nowhere/dds.xml"));
}

TEST(Participant, SaysThatADomainIsOutOfRange) {
  EXPECT_THAT(reason_of_failure({.domain_id = 300, .name = "", .config = ""}),
              HasSubstr("out of range"));
}

/// A UDP port that nobody else can have.
class TakenPort {
 public:
  TakenPort() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    auto* const generic = reinterpret_cast<sockaddr*>(&address_);
    socklen_t size = sizeof address_;
    address_.sin_family = AF_INET;
    is_bound_ = ::bind(socket_, generic, size) == 0 && ::getsockname(socket_, generic, &size) == 0;
  }
  ~TakenPort() { ::close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  bool is_bound() const { return is_bound_; }
  int number() const { return ntohs(address_.sin_port); }

 private:
  int socket_;
  sockaddr_in address_{};
  bool is_bound_ = false;
};

TEST(Participant, SaysThatItsPortIsInUse) {
  const TakenPort taken;
  ASSERT_TRUE(taken.is_bound());
  const int base = taken.number() - 20;  // participant 5: base + 10 + 2 * 5 (RTPS 2.2, 9.6.1)
  const std::string config =
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>5</"
      "ParticipantIndex><Ports><Base>" +
      std::to_string(base) +
      "</Base><DomainGain>0</DomainGain></Ports></Discovery></Domain></CycloneDDS>";
  EXPECT_THAT(reason_of_failure({.domain_id = 212, .name = "", .config = config}),
              HasSubstr("port"));
}

TEST(Participant, CanJoinAgainAfterAFailure) {
  const PrivateBus bus;
  ASSERT_NE(reason_of_failure(
                {.domain_id = bus.domain_id, .name = "", .config = config_with("<Nonsense/>")}),
            "");
  EXPECT_EQ(bus.join().domain_id(), bus.domain_id);
}

TEST(Participant, MeetsOthersOfItsDomainOnly) {
  const PrivateBus here;
  const PrivateBus elsewhere;
  const Participant a = here.join();
  const Participant b = here.join();
  const Participant c = elsewhere.join();
  const Reader<slammot_Odometry> reader(b, topics::kOdometry);
  const Reader<slammot_Odometry> stranger(c, topics::kOdometry);
  const Writer<slammot_Odometry> writer(a, topics::kOdometry);
  EXPECT_TRUE(reader.wait_for_writers(1, kForever));
  EXPECT_TRUE(writer.wait_for_readers(1, kForever));
  EXPECT_EQ(stranger.matched_writers(), 0U);
}

TEST(Participant, LivesOnWhenMoved) {
  const PrivateBus bus;
  Participant first = bus.join();
  const Participant second = std::move(first);
  const Writer<slammot_Odometry> writer(second, topics::kOdometry);
  EXPECT_EQ(writer.matched_readers(), 0U);
}

}  // namespace
}  // namespace slammot::dds
