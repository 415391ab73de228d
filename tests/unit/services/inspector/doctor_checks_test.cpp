#include "services/inspector/doctor_checks.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

using ::testing::HasSubstr;

Computer good_computer() {
  return {8'388'608,   {{"lo", true, true, false}, {"eth0", true, false, true}},
          true,        ClockState{true, 0.5},
          {100.0, ""}, {"performance"}};
}

Finding find(const Computer& computer, const std::string& what) {
  for (const Finding& finding : findings_of(computer)) {
    if (finding.what == what) return finding;
  }
  return {};
}

TEST(Doctor, FindsNothingToChangeOnAGoodComputer) {
  EXPECT_TRUE(std::ranges::all_of(findings_of(good_computer()), &Finding::is_good));
}

TEST(Doctor, AsksForALargerReceiveBuffer) {
  Computer computer = good_computer();
  computer.receive_buffer_bytes = 212'992;
  const Finding finding = find(computer, "receive buffer");
  EXPECT_FALSE(finding.is_good);
  EXPECT_EQ(finding.text, "at most 208 KiB");
  EXPECT_THAT(finding.advice, HasSubstr("sysctl -w net.core.rmem_max=2097152"));
}

TEST(Doctor, AsksForMulticastOrPeers) {
  Computer computer = good_computer();
  computer.receives_multicast = false;
  EXPECT_FALSE(find(computer, "multicast").is_good);
  EXPECT_THAT(find(computer, "multicast").advice, HasSubstr("<Peers>"));
}

TEST(Doctor, AsksForASynchronisedClock) {
  Computer computer = good_computer();
  computer.clock = ClockState{false, 0.0};
  EXPECT_THAT(find(computer, "clock").advice, HasSubstr("chrony"));
  computer.clock = ClockState{true, 50.0};
  EXPECT_FALSE(find(computer, "clock").is_good);
}

TEST(Doctor, AsksForRoomThatCanBeWritten) {
  Computer computer = good_computer();
  computer.state_disk.free_gb = 0.1;
  EXPECT_FALSE(find(computer, "disk").is_good);
  computer.state_disk.fault = "cannot write to state: Read-only file system";
  EXPECT_THAT(find(computer, "disk").text, HasSubstr("Read-only"));
}

TEST(Doctor, AsksForFullSpeed) {
  Computer computer = good_computer();
  computer.governors = {"performance", "powersave"};
  EXPECT_FALSE(find(computer, "CPU governor").is_good);
}

TEST(Doctor, SaysWhichInterfaceIsToBeNamedWhereThereAreSeveral) {
  Computer computer = good_computer();
  computer.interfaces.push_back({"wlan0", true, false, true});
  EXPECT_TRUE(find(computer, "interface").is_good);
  EXPECT_THAT(find(computer, "interface").advice, HasSubstr("NetworkInterface"));
}

TEST(Doctor, WarnsOfOthersInTheDomain) {
  const Finding finding = finding_of_domain(0, {{"slammot-tracking", "", ""}, {"talker", "", ""}});
  EXPECT_FALSE(finding.is_good);
  EXPECT_EQ(finding.text, "domain 0 is shared with talker");
  EXPECT_TRUE(finding_of_domain(0, {{"slammot-tracking", "", ""}}).is_good);
}

}  // namespace
}  // namespace slammot::inspector
