#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "common/work/side_work.hpp"

namespace slammot::testing {

/// The slowest help that may be: whatever is read without waiting is read too early. It shares
/// backwards: whatever needs the part before finds that it is not there.
class HelpAtTheLastMoment : public work::SideWork {
 public:
  void begin(std::function<bool()> step) override {
    wait();
    step_ = std::move(step);
    ++begun_;
  }
  void wait() override {
    while (step_ && step_()) {}
    step_ = nullptr;
  }
  void share(std::size_t parts, const std::function<void(std::size_t)>& part) override {
    ++shared_;
    for (std::size_t i = parts; i-- > 0;) part(i);
  }

  bool is_at_work() const { return step_ != nullptr; }
  int begun() const { return begun_; }
  int shared() const { return shared_; }

 private:
  std::function<bool()> step_;
  int begun_ = 0;
  int shared_ = 0;
};

}  // namespace slammot::testing
