#include "ordered_pairs.h"

#include <algorithm>

#include "stopwatch.h"

namespace stereomotion {
namespace {

void Search(CameraSearch& search, int camera, DetectedPair& pair) {
  Stopwatch watch;
  const auto index = static_cast<std::size_t>(camera);
  pair.searched_whole[index] = camera == 0 ? search.Detect(pair.frames.left, pair.left)
                                           : search.Detect(pair.frames.right, pair.right);
  pair.detect_ms[index] = watch.LapMs();
}

}  // namespace

OrderedPairs::OrderedPairs(const PairSource& source, const Settings& settings)
    : source_(source),
      settings_(settings),
      slots_(static_cast<std::size_t>(2 * settings.threads + 2)),
      next_to_start_(settings.first),
      next_to_hand_out_(settings.first) {
  if (settings.left.search_every > 1) {
    chains_.push_back({CameraSearch(settings.left), settings.first, false});
    chains_.push_back({CameraSearch(settings.right), settings.first, false});
  }
  for (int i = 0; i < std::max(settings.threads, 1); ++i) workers_.emplace_back([this] { Work(); });
}

OrderedPairs::~OrderedPairs() { Stop(); }

void OrderedPairs::Stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

bool OrderedPairs::IsAllStarted() const {
  return next_to_start_ >= settings_.end &&
         std::all_of(chains_.begin(), chains_.end(),
                     [&](const Chain& chain) { return chain.next >= settings_.end; });
}

std::optional<OrderedPairs::Task> OrderedPairs::NextTask() {
  // Searches first: they free the slots that reading needs.
  for (std::size_t camera = 0; camera < chains_.size(); ++camera) {
    Chain& chain = chains_[camera];
    if (chain.busy || chain.next >= next_to_start_ || !SlotOf(chain.next).read) continue;
    chain.busy = true;
    return Task{chain.next++, static_cast<int>(camera)};
  }
  const auto capacity = static_cast<std::int64_t>(slots_.size());
  const bool has_room = next_to_start_ < next_to_hand_out_ + capacity;
  if (next_to_start_ >= settings_.end || !has_room) return std::nullopt;
  return Task{next_to_start_++, -1};
}

bool OrderedPairs::Perform(const Task& task, std::vector<CameraSearch>& own) {
  DetectedPair& pair = SlotOf(task.position).pair;
  if (task.camera >= 0) {
    Search(chains_[static_cast<std::size_t>(task.camera)].search, task.camera, pair);
    return true;
  }
  Stopwatch watch;
  if (!source_.Read(task.position, pair.frames)) return false;
  pair.read_ms = watch.LapMs();
  for (std::size_t i = 0; i < own.size(); ++i) Search(own[i], static_cast<int>(i), pair);
  return true;
}

void OrderedPairs::Finish(const Task& task, bool is_there) {
  if (!is_there) {
    settings_.end = std::min(settings_.end, task.position);
    return;
  }
  Slot& slot = SlotOf(task.position);
  if (task.camera >= 0) {
    slot.searched[static_cast<std::size_t>(task.camera)] = true;
    chains_[static_cast<std::size_t>(task.camera)].busy = false;
    return;
  }
  slot.read = true;
  if (chains_.empty()) slot.searched = {true, true};
}

void OrderedPairs::Work() {
  std::vector<CameraSearch> own;  // where no image depends on another
  if (chains_.empty()) {
    own.emplace_back(settings_.left);
    own.emplace_back(settings_.right);
  }
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    std::optional<Task> task;
    changed_.wait(lock, [&] {
      if (stop_ || error_ || IsAllStarted()) return true;
      task = NextTask();
      return task.has_value();
    });
    if (!task) return;
    lock.unlock();
    std::exception_ptr error;
    bool is_there = true;
    try {
      is_there = Perform(*task, own);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error && !error_) error_ = error;
    Finish(*task, is_there);
    changed_.notify_all();
  }
}

DetectedPair* OrderedPairs::Next() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (handed_out_) {
    Slot& done = SlotOf(next_to_hand_out_);
    done.read = false;
    done.searched = {};
    ++next_to_hand_out_;
    handed_out_ = false;
    changed_.notify_all();
  }
  Slot& slot = SlotOf(next_to_hand_out_);
  const auto is_over = [&] { return next_to_hand_out_ >= settings_.end; };
  changed_.wait(lock, [&] { return is_over() || slot.ready() || error_; });
  if (error_) std::rethrow_exception(error_);
  if (is_over()) return nullptr;
  handed_out_ = true;
  return &slot.pair;
}

}  // namespace stereomotion
