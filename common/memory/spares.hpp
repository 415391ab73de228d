#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace slammot::memory {

/// Things that own memory and are not needed just now. A vector of which now more and now fewer elements are needed loses what
/// those own each time that it is cut; one that is resized with spares does not.
template <typename T>
class Spares {
 public:
  /// What comes back holds what it held when it was last needed: all of it is the caller's to write.
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
