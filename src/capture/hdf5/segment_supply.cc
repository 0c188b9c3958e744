#include "segment_supply.h"

#include <algorithm>
#include <cstdio>

#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

// A large segment may not fit on the disk where a small one still does.
constexpr std::int64_t kFewestFrames = 8;

std::string NameOf(int number) {
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "%06d.h5", number);
  return name.data();
}

bool HasAll(const SegmentWriter& segment, const std::vector<SegmentCamera>& cameras) {
  const auto& has = segment.cameras();
  return std::all_of(cameras.begin(), cameras.end(), [&](const SegmentCamera& camera) {
    return std::any_of(has.begin(), has.end(),
                       [&](const SegmentCamera& other) { return other.name == camera.name; });
  });
}

}  // namespace

SegmentSupply::SegmentSupply(fs::path folder, const DiskCalls& disk)
    : folder_(std::move(folder)), disk_(disk), thread_([this] { Work(); }) {}

SegmentSupply::~SegmentSupply() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::shared_ptr<SegmentWriter> SegmentSupply::Make(
    const std::vector<SegmentCamera>& cameras) const {
  const fs::path file = folder_ / NameOf(number_);
  std::vector<SegmentCamera> smaller = cameras;
  while (true) {
    try {
      return std::make_shared<SegmentWriter>(file, smaller, disk_);
    } catch (const OutputError&) {
      const bool is_small = std::all_of(smaller.begin(), smaller.end(), [](const auto& camera) {
        return camera.capacity <= kFewestFrames;
      });
      if (is_small) throw;
      for (SegmentCamera& camera : smaller) {
        camera.capacity = std::max(camera.capacity / 4, kFewestFrames);
      }
    }
  }
}

void SegmentSupply::Prepare(const std::vector<SegmentCamera>& cameras) {
  const std::lock_guard lock(mutex_);
  cameras_ = cameras;
  wanted_ = true;
  changed_.notify_all();
}

void SegmentSupply::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stop_ || wanted_; });
    if (stop_) return;
    lock.unlock();
    std::shared_ptr<SegmentWriter> made;
    std::exception_ptr error;
    try {
      made = Make(cameras_);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    ready_ = std::move(made);
    error_ = error;
    wanted_ = false;
    changed_.notify_all();
  }
}

std::shared_ptr<SegmentWriter> SegmentSupply::Next(const std::vector<SegmentCamera>& cameras) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !wanted_; });
  if (error_) std::rethrow_exception(error_);
  std::shared_ptr<SegmentWriter> next = std::move(ready_);
  ready_ = nullptr;
  if (next && !HasAll(*next, cameras)) next = nullptr;  // made anew under the same name
  if (!next) next = Make(cameras);
  ++number_;
  return next;
}

void SegmentSupply::Discard() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !wanted_; });
  if (!ready_) return;
  std::error_code none;
  fs::remove(ready_->file(), none);
  ready_ = nullptr;
}

}  // namespace stereomotion
