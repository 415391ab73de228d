#include "common/app/stop_signal.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <system_error>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace slammot::app {
namespace {

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

int checked(int descriptor, const char* what) {
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), what);
  return descriptor;
}

}  // namespace

StopSignal::StopSignal(std::function<void()> stop) : stop_(std::move(stop)) {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signals_ = checked(::signalfd(-1, &signals, SFD_CLOEXEC), "signalfd");
  quit_ = checked(::eventfd(0, EFD_CLOEXEC), "eventfd");
  thread_ = std::thread([this] { watch(); });
}

StopSignal::~StopSignal() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(quit_, &one, sizeof one);
  thread_.join();
  ::close(quit_);
  ::close(signals_);
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

void StopSignal::watch() {
  bool stopped = false;
  for (;;) {
    std::array<pollfd, 2> waited = {pollfd{signals_, POLLIN, 0}, pollfd{quit_, POLLIN, 0}};
    if (::poll(waited.data(), waited.size(), -1) < 0) continue;  // only EINTR
    if (waited[1].revents != 0) return;
    signalfd_siginfo signal{};
    if (::read(signals_, &signal, sizeof signal) != sizeof signal) continue;
    if (stopped) std::_Exit(128 + static_cast<int>(signal.ssi_signo));
    stopped = true;
    stop_();
  }
}

}  // namespace slammot::app
