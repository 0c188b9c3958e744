#include "hdf5_store.h"

#include <algorithm>
#include <mutex>
#include <optional>

#include "../same_images.h"
#include "join_segments.h"
#include "prepare_output.h"
#include "rate_meter.h"
#include "recording_lock.h"
#include "segment_capacity.h"
#include "segment_supply.h"
#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

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
  template <class Act>
  void Trusted(const Act& act);
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
  bool is_distrusted_ = false;  // of whoever flushes and closes
  std::mutex mutex_;            // guards `open_`
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
    RequireSameImages(options_.output.string(), camera->name,
                      {nullptr, camera->width_px, camera->height_px, 0, camera->type}, image);
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
  std::int64_t image_bytes = 0;
  for (const auto& camera : known_) image_bytes += camera ? camera->image_bytes() : 0;
  return SegmentCapacity(rate_, options_.segment_s, started_, image_bytes, known_[0] && known_[1]);
}

void Hdf5Store::StartSegment() {
  current_ = supply_.Next(Cameras());
  next_row_ = {};
  ++started_;
  {
    const std::lock_guard lock(mutex_);
    open_.push_back(current_);
  }
  if (known_[0] && known_[1]) supply_.Prepare(Cameras());
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

// Where the disk refuses, rows may be torn that are not noted as brought to it.
template <class Act>
void Hdf5Store::Trusted(const Act& act) {
  try {
    act();
  } catch (const OutputError&) {
    is_distrusted_ = true;
    lock_.Distrust();
    throw;
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
      Trusted([&] { segment->Sync(); });
      continue;
    }
    Trusted([&] { segment->Close(); });
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
      Trusted([&] { segment->Close(); });
    } catch (const OutputError&) {
      error = std::current_exception();  // the other segments are as good as ever
    }
  }
  open_.clear();
  lock_.FreeReserve();
  const JoinedSegments joined = JoinSegments(options_.output, /*trust_all=*/!is_distrusted_);
  // The mark stays: the recording is not whole, and a repair may find the segment readable again.
  if (!joined.notes.empty()) throw OutputError(joined.notes.front());
  lock_.Remove();
  if (started_ == 0) RemoveEmpty(options_.output);
  if (error && !failed) std::rethrow_exception(error);
}

}  // namespace

std::unique_ptr<FrameStore> MakeHdf5Store(const RecorderOptions& options, const DiskCalls& disk) {
  RecorderOptions real = options;
  real.output = LinkedFile(options.output);
  PrepareOutput(real);
  return std::make_unique<Hdf5Store>(real, disk);
}

}  // namespace stereomotion
