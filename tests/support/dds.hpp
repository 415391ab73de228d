#pragma once

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/dds/config.hpp"
#include "common/dds/participant.hpp"

namespace slammot::testing {

/// Longer than anything on a busy machine takes: a test that waits so long has failed.
inline constexpr std::chrono::seconds kForever{20};

/// A bus of its own on loopback, also where several tests run at once: own domain and own discovery
/// tag.
struct PrivateBus {
  std::uint32_t domain_id;
  std::string config;

  PrivateBus() {
    static std::atomic<std::uint32_t> made{0};
    const std::uint32_t number = made++;
    domain_id = 1 + (static_cast<std::uint32_t>(getpid()) + 31 * number) % 200;
    config =
        dds::loopback_config("test-" + std::to_string(getpid()) + "-" + std::to_string(number));
  }

  dds::Participant join(const std::string& name = "test") const {
    return dds::Participant({.domain_id = domain_id, .name = name, .config = config});
  }
};

/// Fills a fixed-size string of a generated struct.
template <std::size_t kSize>
void assign(char (&target)[kSize], std::string_view text) {
  const std::size_t length = std::min(text.size(), kSize - 1);
  std::copy_n(text.data(), length, target);
  target[length] = '\0';
}

}  // namespace slammot::testing
