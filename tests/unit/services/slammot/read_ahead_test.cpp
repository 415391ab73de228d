#include "services/slammot/read_ahead.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/slammot/room_log.hpp"

namespace slammot {
namespace {

class AReadAhead : public ::testing::Test {
 protected:
  void write(int scans) const { std::ofstream(path_) << testing::room_log(scans); }
  files::CarmenLog open() const { return std::move(*files::CarmenLog::open(path_)); }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "room.log";
};

std::int64_t stamp_of(const files::LogEvent& event) {
  return std::visit([](const auto& one) { return one.stamp_ns; }, event);
}

TEST_F(AReadAhead, ReturnsTheEventsOfTheLogInOrder) {
  write(300);
  files::CarmenLog log = open();
  files::CarmenLog again = open();
  ReadAhead ahead(log);
  int events = 0;
  double fraction_read = 0.0;
  while (const auto event = again.next()) {
    const auto read = ahead.next();
    ASSERT_TRUE(read);
    ASSERT_EQ(read->event.index(), event->index());
    ASSERT_EQ(stamp_of(read->event), stamp_of(*event));
    ASSERT_GE(read->fraction_read, fraction_read);
    fraction_read = read->fraction_read;
    ++events;
  }
  EXPECT_EQ(events, 600);
  EXPECT_FALSE(ahead.next());
  EXPECT_FALSE(ahead.next());
}

TEST_F(AReadAhead, EndsWithMostOfTheLogUnread) {
  write(2000);
  files::CarmenLog log = open();
  {
    ReadAhead ahead(log);
    ASSERT_TRUE(ahead.next());
  }
  int left = 0;
  while (log.next()) ++left;
  EXPECT_GT(left, 2000);  // it stops reading when it is far enough ahead
}

}  // namespace
}  // namespace slammot
