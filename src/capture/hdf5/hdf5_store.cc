#include "hdf5_store.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "join_segments.h"
#include "prepare_output.h"
#include "rate_meter.h"
#include "recording_lock.h"
#include "segment_supply.h"
#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

// Before the rate is known.
constexpr std::int64_t kFirstCapacity = 32;
constexpr std::int64_t kSmallestCapacity = 8;
// After so many segments they become twice as long: a reader of the whole recording may hold each
// of them open (HDF5 does), and 1024 open files are what a program is given. A crash costs no more
// for it: what is written counts frame by frame.
constexpr int kSegmentsOfOneLength = 64;
// Room that is taken ahead should not fill a disk.
constexpr std::int64_t kLargestSegmentBytes = std::int64_t{4} << 30;

class Hdf5Store : public FrameStore {
 public:
  Hdf5Store(RecorderOptions options, DiskCalls disk)
      : options_(std::move(options)),
        disk_(std::move(disk)),
        lock_(options_.output, RecordingLock::Use::kRecord),
        supply_(SegmentFolder(options_.output), disk_) {}

  int writers() const override { return 2; }
  RingPlace Reserve(const RingItem& item) override;
  void Write(const RingItem& item, const RingPlace& place) override;
  void Flush() override;
  void Close(bool failed) override;

 private:
  bool Learn(const RingItem& item);
  [[nodiscard]] bool HasRoom(const RingItem& item) const;
  [[nodiscard]] std::vector<SegmentCamera> Cameras() const;
  void StartSegment();
  [[nodiscard]] std::int64_t Capacity() const;
  [[nodiscard]] std::size_t PlaceOf(std::size_t side) const;

  const RecorderOptions options_;
  const DiskCalls disk_;
  RecordingLock lock_;
  // These belong to whoever reserves.
  std::array<std::optional<SegmentCamera>, 2> known_;  // left, right, once they sent an image
  std::array<std::int64_t, 2> next_row_{};             // left, right
  std::shared_ptr<SegmentWriter> current_;
  int started_ = 0;
  RateMeter rate_;
  std::mutex mutex_;  // guards `open_`
  std::vector<std::shared_ptr<SegmentWriter>> open_;
  SegmentSupply supply_;
};

// True: a camera was seen for the first time.
bool Hdf5Store::Learn(const RingItem& item) {
  bool is_new = false;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!item.frames[side]) continue;
    const ImageView image = item.frames[side]->image.View();
    std::optional<SegmentCamera>& camera = known_[side];
    if (!camera) {
      camera = {options_.names[side], image.width_px, image.height_px, image.type, 0,
                image.grey_bits};
      is_new = true;
    }
    if (image.width_px == camera->width_px && image.height_px == camera->height_px &&
        image.type == camera->type) {
      continue;
    }
    throw OutputError(options_.output.string() + ": camera " + camera->name +
                      " now sends images of " + std::to_string(image.width_px) + " x " +
                      std::to_string(image.height_px) + " px, before " +
                      std::to_string(camera->width_px) + " x " + std::to_string(camera->height_px) +
                      " px; a recording holds one size");
  }
  return is_new;
}

std::size_t Hdf5Store::PlaceOf(std::size_t side) const { return side == 1 && known_[0] ? 1 : 0; }

bool Hdf5Store::HasRoom(const RingItem& item) const {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!item.frames[side]) continue;
    if (next_row_[side] >= current_->cameras()[PlaceOf(side)].capacity) return false;
  }
  return true;
}

std::vector<SegmentCamera> Hdf5Store::Cameras() const {
  std::vector<SegmentCamera> cameras;
  for (const auto& camera : known_) {
    if (camera) cameras.push_back(*camera);
  }
  const std::int64_t capacity = Capacity();
  for (SegmentCamera& camera : cameras) camera.capacity = capacity;
  return cameras;
}

std::int64_t Hdf5Store::Capacity() const {
  const int doublings = std::min(started_ / kSegmentsOfOneLength, 16);
  const std::int64_t wanted = rate_.FramesIn(std::ldexp(options_.segment_s, doublings));
  std::int64_t image_bytes = 0;
  for (const auto& camera : known_) image_bytes += camera ? camera->image_bytes() : 0;
  const std::int64_t most = kLargestSegmentBytes / std::max<std::int64_t>(image_bytes, 1);
  const std::int64_t capacity = wanted > 0 ? wanted : kFirstCapacity;
  return std::max(std::min(capacity, most), kSmallestCapacity);
}

void Hdf5Store::StartSegment() {
  current_ = supply_.Next(Cameras());
  next_row_ = {};
  ++started_;
  {
    const std::lock_guard lock(mutex_);
    open_.push_back(current_);
  }
  supply_.Prepare(Cameras());
}

RingPlace Hdf5Store::Reserve(const RingItem& item) {
  rate_.Add(item);
  if (Learn(item) || !current_ || !HasRoom(item)) StartSegment();
  RingPlace place{current_, {}, {}};
  for (std::size_t side = 0; side < 2; ++side) {
    if (!item.frames[side]) continue;
    place.cameras[side] = PlaceOf(side);
    place.rows[side] = next_row_[side]++;
  }
  return place;
}

void Hdf5Store::Write(const RingItem& item, const RingPlace& place) {
  SegmentWriter& segment = *place.segment;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!item.frames[side]) continue;
    segment.WriteImage(place.cameras[side], place.rows[side], item.frames[side]->image.View());
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!item.frames[side]) continue;
    segment.Commit(place.cameras[side], place.rows[side], *item.frames[side], item.pair);
  }
}

void Hdf5Store::Flush() {
  std::vector<std::shared_ptr<SegmentWriter>> open;
  {
    const std::lock_guard lock(mutex_);
    open = open_;
  }
  for (auto& segment : open) {
    // Besides this list and `open_` nobody has a segment that is full and written.
    constexpr int kUnused = 2;
    const bool is_done = segment.use_count() == kUnused;
    if (!is_done) {
      segment->Sync();
      continue;
    }
    segment->Close();
    const std::lock_guard lock(mutex_);
    open_.erase(std::find(open_.begin(), open_.end(), segment));
  }
}

void Hdf5Store::Close(bool failed) {
  supply_.Discard();
  current_ = nullptr;
  std::exception_ptr error;
  for (auto& segment : open_) {
    try {
      segment->Close();
    } catch (const OutputError&) {
      error = std::current_exception();  // the other segments are as good as ever
    }
  }
  open_.clear();
  lock_.FreeReserve();
  JoinSegments(options_.output, /*trust_all=*/true);
  lock_.Remove();
  if (error && !failed) std::rethrow_exception(error);
}

}  // namespace

std::unique_ptr<FrameStore> MakeHdf5Store(const RecorderOptions& options, const DiskCalls& disk) {
  PrepareOutput(options);
  return std::make_unique<Hdf5Store>(options, disk);
}

}  // namespace stereomotion
