#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace slammot::sensing {

/// Fewer than `most` of the values that are added, evenly spread over all of them: when so many are
/// kept, every other one is dropped, and of those that follow half as many are taken as before.
template <typename Value>
class Thinned {
 public:
  explicit Thinned(std::size_t most) : most_(most) {}

  void add(Value value) {
    if (added_++ % every_ != 0) return;
    kept_.push_back(std::move(value));
    if (kept_.size() < most_) return;
    every_ *= 2;
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i) std::swap(kept_[i], kept_[2 * i]);
    kept_.resize((kept_.size() + 1) / 2);
  }

  const std::vector<Value>& kept() const { return kept_; }

 private:
  std::size_t most_;
  std::vector<Value> kept_;
  std::size_t every_ = 1;  // so many added values for one that is taken
  std::size_t added_ = 0;
};

}  // namespace slammot::sensing
