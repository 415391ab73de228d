#include "services/ingest/scan_window.hpp"

namespace slammot::ingest {

void ScanWindow::sent(std::int64_t stamp_ns, Time now) {
  if (in_flight_.empty()) last_progress_ = now;
  in_flight_.push_back({stamp_ns, 1});
}

std::size_t ScanWindow::acknowledge(std::int64_t stamp_ns, Time now) {
  const std::size_t done =
      std::erase_if(in_flight_, [stamp_ns](const Scan& scan) { return scan.stamp_ns <= stamp_ns; });
  if (done > 0) last_progress_ = now;
  return done;
}

std::size_t ScanWindow::resend(Time now) {
  last_progress_ = now;
  const std::size_t given_up = std::erase_if(
      in_flight_, [this](const Scan& scan) { return scan.sendings >= limits_.max_sendings; });
  for (Scan& scan : in_flight_) ++scan.sendings;
  return given_up;
}

}  // namespace slammot::ingest
