#include "pair_queue.h"

#include <algorithm>

#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

/// Readers that fetch ahead do so by less.
constexpr std::int64_t kReadAhead = 512;

std::int64_t BytesOf(const std::shared_ptr<const Frame>& frame) {
  if (!frame) return 0;
  const ImageView view = frame->image.View();
  return view.stride_bytes * view.height_px;
}

}  // namespace

PairQueue::Header PairQueue::HeaderOf(const Frame& frame) {
  return {frame.index, frame.timestamp_ns, frame.device_ns, frame.exposure_us};
}

std::int64_t PairQueue::Bytes(const Row& row) { return BytesOf(row.left) + BytesOf(row.right); }

void PairQueue::Add(const std::shared_ptr<const Frame>& left,
                    const std::shared_ptr<const Frame>& right, std::int64_t now_ns) {
  Row row{left,  right, HeaderOf(*left), right ? HeaderOf(*right) : Header(), right != nullptr,
          now_ns};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::int64_t place = size_++;
    if (place < kPairsKept) {
      kept_[static_cast<std::size_t>(place)] = std::move(row);
    } else {
      bytes_ += Bytes(row);
      ++queued_;
      rows_.push_back(std::move(row));
      DropOldest();
      most_queued_ = std::max(most_queued_, queued_);
    }
  }
  changed_.notify_all();
}

void PairQueue::Release(Row& row) {
  bytes_ -= Bytes(row);
  --queued_;
  row.left.reset();
  row.right.reset();
}

void PairQueue::DropOldest() {
  const std::int64_t newest_ns = rows_.back().added_ns;
  for (; next_drop_ < size_ - 1; ++next_drop_) {
    if (next_drop_ < first_) continue;
    Row& row = rows_[static_cast<std::size_t>(next_drop_ - first_)];
    if (!row.left) continue;  // taken
    const double age_s = static_cast<double>(newest_ns - row.added_ns) * kSecondsPerNs;
    if (age_s <= limits_.seconds && bytes_ <= limits_.bytes) return;
    dropped_ += row.right ? 1 : 0;
    Release(row);
  }
}

void PairQueue::End() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

PairQueue::Row PairQueue::TakeRow(std::int64_t position) {
  if (position < kPairsKept) return kept_[static_cast<std::size_t>(position)];
  if (has_kept_ && position >= kPairsKept + kReadAhead) {
    kept_.fill(Row());
    has_kept_ = false;
  }
  if (position < first_) return {};
  Row& row = rows_[static_cast<std::size_t>(position - first_)];
  Row copy = row;
  if (row.left) Release(row);
  row.left_header.index = -1;  // taken
  while (!rows_.empty() && rows_.front().left_header.index < 0) {
    rows_.pop_front();
    ++first_;
  }
  return copy;
}

void PairQueue::Fill(const std::shared_ptr<const Frame>& image, const Header& header,
                     Frame& frame) {
  if (image) {
    frame = *image;
    return;
  }
  frame.index = header.index;
  frame.timestamp_ns = header.timestamp_ns;
  frame.device_ns = header.device_ns;
  frame.exposure_us = header.exposure_us;
  frame.image.Resize(0, 0, PixelType::kGray8);
  frame.dropped = header.index >= 0;
  frame.problem = frame.dropped ? "measuring was too slow for this pair" : "";
}

bool PairQueue::Read(std::int64_t position, FramePair& pair) {
  Row row;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || position < size_; });
    if (position >= size_) return false;
    row = TakeRow(position);
  }
  Fill(row.left, row.left_header, pair.left);
  Fill(row.right, row.right_header, pair.right);
  if (!row.has_right) pair.right.problem = "the left frame has no partner";
  return true;
}

std::int64_t PairQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

std::int64_t PairQueue::most_queued() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return most_queued_;
}

}  // namespace stereomotion
