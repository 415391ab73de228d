#include "common/app/supervisor.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

/// The socket of a supervisor, as systemd makes it.
class Notices : public ::testing::Test {
 protected:
  Notices() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
  }
  ~Notices() override {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
  }
  std::string next() const {
    char bytes[512];
    const ssize_t length = recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
    return length < 0 ? "" : std::string(bytes, static_cast<std::size_t>(length));
  }

 private:
  testing::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "notify").string();
  int socket_ = socket(AF_UNIX, SOCK_DGRAM, 0);
};

TEST_F(Notices, SayThatADegradedServiceHasStartedAndWhatItLacks) {
  tell_supervisor(wire::ServiceState::kDegraded, "no slammot/laser_scan yet");
  EXPECT_EQ(next(), "READY=1\nSTATUS=degraded: no slammot/laser_scan yet");
}

TEST_F(Notices, SayThatAServiceStops) {
  tell_supervisor(wire::ServiceState::kStopping, "");
  EXPECT_EQ(next(), "STOPPING=1\nSTATUS=stopping");
}

TEST_F(Notices, KeepAnExplanationInOneFieldWhateverItHolds) {
  tell_supervisor(wire::ServiceState::kDegraded, "a\nREADY=0");
  EXPECT_EQ(next(), "READY=1\nSTATUS=degraded: a READY=0");
}

TEST_F(Notices, FeedTheWatchdog) {
  tell_supervisor_alive();
  EXPECT_EQ(next(), "WATCHDOG=1");
}

TEST(Supervisor, MayBeAbsent) {
  unsetenv("NOTIFY_SOCKET");
  tell_supervisor(wire::ServiceState::kRunning, "");
  tell_supervisor_alive();
}

}  // namespace
}  // namespace slammot::app
