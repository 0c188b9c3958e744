#include "frame_pool.h"

#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace stereomotion {

struct FramePool::State {
  std::mutex mutex;
  std::vector<std::unique_ptr<Frame>> frames;
  std::vector<void*> blocks;  ///< of the shared pointers, all of one size
  std::int64_t made = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    for (void* block : blocks) ::operator delete(block);
  }
};

namespace {

/// Gives a frame back to its pool when the last shared pointer to it is gone.
struct GiveBack {
  std::shared_ptr<FramePool::State> state;
  void operator()(Frame* frame) const {
    std::unique_ptr<Frame> owned(frame);
    const std::lock_guard<std::mutex> lock(state->mutex);
    state->frames.push_back(std::move(owned));
  }
};

/// Takes the shared pointers' own memory from the pool.
template <class T>
struct BlockAllocator {
  using value_type = T;
  std::shared_ptr<FramePool::State> state;

  explicit BlockAllocator(std::shared_ptr<FramePool::State> pool) : state(std::move(pool)) {}
  template <class U>
  BlockAllocator(const BlockAllocator<U>& other) : state(other.state) {}  // NOLINT: rebinding

  T* allocate(std::size_t n) {
    const std::lock_guard<std::mutex> lock(state->mutex);
    if (state->blocks.empty()) return static_cast<T*>(::operator new(n * sizeof(T)));
    void* block = state->blocks.back();
    state->blocks.pop_back();
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t) {
    const std::lock_guard<std::mutex> lock(state->mutex);
    state->blocks.push_back(block);
  }
  template <class U>
  bool operator==(const BlockAllocator<U>& other) const {
    return state == other.state;
  }
  template <class U>
  bool operator!=(const BlockAllocator<U>& other) const {
    return state != other.state;
  }
};

}  // namespace

FramePool::FramePool() : state_(std::make_shared<State>()) {}

std::shared_ptr<Frame> FramePool::Take() {
  std::unique_ptr<Frame> frame;
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    if (!state_->frames.empty()) {
      frame = std::move(state_->frames.back());
      state_->frames.pop_back();
    } else {
      ++state_->made;
    }
  }
  if (!frame) frame = std::make_unique<Frame>();
  return {frame.release(), GiveBack{state_}, BlockAllocator<Frame>(state_)};
}

std::int64_t FramePool::made() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->made;
}

}  // namespace stereomotion
