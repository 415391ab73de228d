#pragma once

#include <cassert>
#include <cstddef>
#include <iterator>
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
  auto all() { return Elements<RecyclingQueue, T>{this}; }
  auto all() const { return Elements<const RecyclingQueue, const T>{this}; }

 private:
  template <typename Queue, typename Element>
  struct Iterator {
    using value_type = T;
    using difference_type = std::ptrdiff_t;

    Element& operator*() const { return (*queue)[i]; }
    Iterator& operator++() { return ++i, *this; }
    Iterator operator++(int) { return {queue, i++}; }
    bool operator==(const Iterator&) const = default;

    Queue* queue = nullptr;
    std::size_t i = 0;
  };

  /// std::views would do, but clang before 16 does not compile those of libstdc++.
  template <typename Queue, typename Element>
  struct Elements {
    Iterator<Queue, Element> begin() const { return {queue, 0}; }
    Iterator<Queue, Element> end() const { return {queue, queue->size()}; }

    Queue* queue = nullptr;
  };

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
