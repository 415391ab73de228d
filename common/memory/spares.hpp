#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace slammot::memory {

/// Pool of elements that own memory. Shrinking a vector frees its elements' memory; resizing it
/// with spares keeps that memory.
template <typename T>
class Spares {
 public:
  /// A reused element has its old content, which the caller must overwrite.
  void resize(std::vector<T>& things, std::size_t count) {
    while (things.size() > count) {
      give(std::move(things.back()));
      things.pop_back();
    }
    while (things.size() < count) things.push_back(take());
  }

  void give(T thing) { spares_.push_back(std::move(thing)); }

  T take() {
    if (spares_.empty()) return T{};
    T thing = std::move(spares_.back());
    spares_.pop_back();
    return thing;
  }

 private:
  std::vector<T> spares_;
};

}  // namespace slammot::memory
