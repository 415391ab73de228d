#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "common/files/run_report.hpp"

namespace slammot {

/// Duration of each call of each stage.
class StageTimes {
 public:
  /// Runs the stage and returns its result.
  template <typename Stage>
  decltype(auto) measure(const std::string& name, Stage&& stage) {
    const Stopwatch stopwatch(durations_of(name));
    return std::forward<Stage>(stage)();
  }

  std::vector<files::StageLatency> summary() const {
    std::vector<files::StageLatency> stages;
    for (const auto& [name, durations_ms] : durations_ms_)
      stages.push_back(files::summarize_latency(name, durations_ms));
    return stages;
  }

 private:
  class Stopwatch {
   public:
    explicit Stopwatch(std::vector<double>& durations_ms) : durations_ms_(durations_ms) {}
    ~Stopwatch() {
      durations_ms_.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
              .count());
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

   private:
    std::vector<double>& durations_ms_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  std::vector<double>& durations_of(const std::string& name) {
    for (auto& [known, durations_ms] : durations_ms_) {
      if (known == name) return durations_ms;
    }
    return durations_ms_.emplace_back(name, std::vector<double>()).second;
  }

  // In the order of first use. A deque keeps references valid.
  std::deque<std::pair<std::string, std::vector<double>>> durations_ms_;
};

}  // namespace slammot
