#include "services/gateway/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::gateway {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string metrics_with_scan_age(double age_s) {
  GatewayFigures figures;
  figures.scan_age_s = age_s;
  return metrics_text("car", {}, {}, figures, {});
}

TEST(Metrics, HaveAnInfiniteScanAgeBeforeTheFirstScan) {
  EXPECT_THAT(metrics_with_scan_age(-1.0),
              HasSubstr("slammot_gateway_scan_age_seconds{vehicle=\"car\"} +Inf"));
  EXPECT_THAT(metrics_with_scan_age(0.5),
              HasSubstr("slammot_gateway_scan_age_seconds{vehicle=\"car\"} 0.5"));
}

TEST(Metrics, NameTheVersion) {
  EXPECT_THAT(metrics_with_scan_age(0.0), HasSubstr("slammot_build_info{version=\""));
}

TEST(Metrics, HaveTheStateOfEachServiceHeard) {
  ServiceBoard board;
  wire::Heartbeat beat;
  beat.name = {"car", "tracking", "main"};
  beat.state = wire::ServiceState::kRunning;
  const ServiceBoard::Time heard{};
  board.take(beat, heard);
  const std::string up =
      "slammot_service_up{service=\"tracking\",instance_name=\"main\",vehicle=\"car\"} ";
  EXPECT_THAT(metrics_text("car", board, {}, {}, heard), HasSubstr(up + "1"));
  EXPECT_THAT(metrics_text("car", board, {}, {}, heard + std::chrono::seconds(20)),
              Not(HasSubstr(up + "1")));
}

}  // namespace
}  // namespace slammot::gateway
