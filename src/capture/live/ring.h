#pragma once

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace stereomotion {

/// Holds a queue in memory that is used again: it grows to the most that ever waited, and a frame
/// costs no allocation after that (a `std::deque` allocates as it moves along).
template <class T>
class Ring {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return slots_[Place(i)]; }
  const T& operator[](std::size_t i) const { return slots_[Place(i)]; }
  T& front() { return (*this)[0]; }
  const T& front() const { return (*this)[0]; }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }

  void push_back(T value) {
    if (size_ == slots_.size()) Grow();
    slots_[Place(size_)] = std::move(value);
    ++size_;
  }
  T pop_front() {
    assert(size_ > 0);
    T value = std::exchange(slots_[first_], T{});  // lets go of what the slot held
    first_ = (first_ + 1) % slots_.size();
    --size_;
    return value;
  }
  void clear() {
    while (!empty()) pop_front();
  }

 private:
  [[nodiscard]] std::size_t Place(std::size_t i) const { return (first_ + i) % slots_.size(); }
  void Grow() {
    constexpr std::size_t kLeast = 16;
    std::vector<T> larger(slots_.empty() ? kLeast : 2 * slots_.size());
    for (std::size_t i = 0; i < size_; ++i) larger[i] = std::move((*this)[i]);
    slots_ = std::move(larger);
    first_ = 0;
  }

  std::vector<T> slots_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace stereomotion
