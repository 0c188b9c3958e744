#include "segment_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

}  // namespace

SegmentWriter::SegmentWriter(fs::path file, std::vector<SegmentCamera> cameras,
                             const DiskCalls& disk)
    : file_(std::move(file)), cameras_(std::move(cameras)), disk_(disk) {
  for (const SegmentCamera& camera : cameras_) {
    committed_.emplace_back(static_cast<std::size_t>(camera.capacity), false);
  }
  try {
    Open();
  } catch (...) {
    if (fd_ >= 0) close(fd_);
    unlink((file_.string() + ".part").c_str());
    throw;
  }
}

void SegmentWriter::Open() {
  const std::string part = file_.string() + ".part";
  offsets_ = CreateSegment(part, cameras_);
  fd_ = open(part.c_str(), O_RDWR | O_CLOEXEC);
  if (fd_ < 0) Fail("cannot be opened");
  const off_t bytes = lseek(fd_, 0, SEEK_END);
  if (disk_.allocate(fd_, bytes) != 0) Fail("there is no room for it");
  // Its metadata must be on the disk before its name is: whatever has the name can be opened.
  if (disk_.sync(fd_) != 0) Fail("cannot be written");
  if (std::rename(part.c_str(), file_.c_str()) != 0) Fail("cannot be named");
  SyncFolderOf(file_);  // a name that a power cut takes away would take the frames with it
}

SegmentWriter::~SegmentWriter() {
  if (fd_ >= 0) close(fd_);
}

void SegmentWriter::Fail(const char* what) const {
  throw OutputError(file_.string() + ": " + what + ": " + std::strerror(errno));
}

void SegmentWriter::Write(const void* data, std::int64_t bytes, std::int64_t offset) {
  if (!WriteAt(disk_, fd_, data, bytes, offset)) Fail("cannot be written");
}

void SegmentWriter::WriteImage(std::size_t camera, std::int64_t row, const ImageView& image) {
  const std::int64_t at = offsets_[camera].images + row * cameras_[camera].image_bytes();
  if (!WriteImageAt(disk_, fd_, image, at)) Fail("cannot be written");
}

void SegmentWriter::Commit(std::size_t camera, std::int64_t row, const Frame& frame,
                           std::int64_t pair) {
  const auto put = [&](FrameColumn column, const auto& cell) {
    static_assert(sizeof(cell) == kCellBytes);
    Write(&cell, kCellBytes, offsets_[camera].columns[column] + row * kCellBytes);
  };
  put(kTimestamp, frame.timestamp_ns);
  put(kExposure, frame.exposure_us);
  put(kDeviceTimestamp, frame.device_ns);
  put(kPair, pair);
  put(kFrame, frame.index);
  const std::lock_guard lock(mutex_);
  committed_[camera][static_cast<std::size_t>(row)] = true;
}

std::vector<std::int64_t> SegmentWriter::CommittedWithoutGap() {
  const std::lock_guard lock(mutex_);
  std::vector<std::int64_t> counts;
  for (const auto& rows : committed_) {
    counts.push_back(std::find(rows.begin(), rows.end(), false) - rows.begin());
  }
  return counts;
}

void SegmentWriter::SyncOrFail() {
  if (is_lost_) errno = EIO;
  is_lost_ = is_lost_ || disk_.sync(fd_) != 0;
  if (is_lost_) Fail("cannot be brought to the disk");
}

void SegmentWriter::Sync() {
  const std::vector<std::int64_t> counts = CommittedWithoutGap();
  SyncOrFail();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    Write(&counts[i], kCellBytes, offsets_[i].synced);
  }
}

void SegmentWriter::GiveBack(std::size_t camera) {
  const SegmentCamera& shape = cameras_[camera];
  const auto& rows = committed_[camera];
  const std::int64_t used = rows.rend() - std::find(rows.rbegin(), rows.rend(), true);
  const std::int64_t begin = offsets_[camera].images;
  GiveBackRoom(fd_, begin + used * shape.image_bytes(),
               begin + shape.capacity * shape.image_bytes());
}

void SegmentWriter::Close() {
  Sync();
  for (std::size_t i = 0; i < cameras_.size(); ++i) GiveBack(i);
  SyncOrFail();
  // Whatever `close` says, the number may be another file's from then on.
  if (close(std::exchange(fd_, -1)) != 0) Fail("cannot be closed");
}

}  // namespace stereomotion
