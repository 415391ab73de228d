#include "services/slammot/installed_environment.hpp"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

TEST(BusEnvironment, HoldsBusAndVehicle) {
  EXPECT_THAT(
      bus_environment("# bus\nSLAMMOT_DOMAIN=3\nCYCLONEDDS_URI=file:///a.xml,file:///b.xml\n"
                      "SLAMMOT_VEHICLE=\"my car\"\n"),
      ElementsAre(Pair("SLAMMOT_DOMAIN", "3"),
                  Pair("CYCLONEDDS_URI", "file:///a.xml,file:///b.xml"),
                  Pair("SLAMMOT_VEHICLE", "my car")));
}

TEST(BusEnvironment, LeavesOutTheRest) {
  EXPECT_THAT(
      bus_environment(
          "#SLAMMOT_INTERFACE=eth1\nOPTIONS=\"--profile urban\"\nPATH=/tmp\nSLAMMOT_DOMAIN\n\n"),
      IsEmpty());
  EXPECT_THAT(bus_environment(""), IsEmpty());
}

TEST(BusEnvironment, IsNotThatOfAProgramBuiltHere) {
  take_environment_of_services("build/release/bin/slammot");
  EXPECT_EQ(std::getenv("SLAMMOT_INTERFACE"), nullptr);
}

}  // namespace
}  // namespace slammot
