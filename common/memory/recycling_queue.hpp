#pragma once

#include <cassert>
#include <cstddef>
#include <ranges>
#include <utility>
#include <vector>

namespace slammot::memory {

/// FIFO queue that recycles its elements. Removed elements stay in memory and are reused. It
/// allocates only beyond its largest size so far, and where elements allocate themselves; write
/// over an element to keep its memory.
template <typename T>
class RecyclingQueue {
 public:
  RecyclingQueue() = default;
  /// Reserves this capacity, with constructed elements.
  explicit RecyclingQueue(std::size_t places) : places_(places) {}

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }

  /// 0 is the oldest element.
  T& operator[](std::size_t i) { return places_[place_of(i)]; }
  const T& operator[](std::size_t i) const { return places_[place_of(i)]; }
  T& front() { return (*this)[0]; }
  const T& front() const { return (*this)[0]; }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }

  /// Appends a recycled element with its old content, which the caller must overwrite. Invalidates
  /// references to other elements.
  T& push_back() {
    if (size_ == places_.size()) make_room();
    ++size_;
    return back();
  }

  void pop_front() {
    assert(size_ > 0);
    first_ = place_of(1);
    --size_;
  }

  void pop_back() {
    assert(size_ > 0);
    --size_;
  }

  void clear() { size_ = 0; }

  /// All elements, oldest first.
  auto all() {
    return std::views::iota(std::size_t{0}, size_) |
           std::views::transform([this](std::size_t i) -> T& { return (*this)[i]; });
  }
  auto all() const {
    return std::views::iota(std::size_t{0}, size_) |
           std::views::transform([this](std::size_t i) -> const T& { return (*this)[i]; });
  }

 private:
  std::size_t place_of(std::size_t i) const {
    return first_ + i < places_.size() ? first_ + i : first_ + i - places_.size();
  }

  void make_room() {
    std::vector<T> places;
    places.reserve(2 * places_.size() + 1);
    for (std::size_t i = 0; i < size_; ++i) places.push_back(std::move((*this)[i]));
    places.resize(places.capacity());
    places_ = std::move(places);
    first_ = 0;
  }

  std::vector<T> places_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace slammot::memory
