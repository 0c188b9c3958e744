#include "folder_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "folder_lock.h"
#include "hdf5/prepare_output.h"
#include "same_images.h"
#include "stereomotion/core/output_error.h"
#include "timestamps_csv.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& file) {
  throw OutputError(file.string() + ": cannot be written: " + std::strerror(errno));
}

// PGM has the high byte of 16-bit pixels first.
void SwapBytes(const ImageView& image, std::vector<std::uint8_t>& swapped) {
  const auto row_bytes = static_cast<std::size_t>(image.width_px) * 2;
  swapped.resize(row_bytes * static_cast<std::size_t>(image.height_px));
  for (int v = 0; v < image.height_px; ++v) {
    const auto* from = image.Row<std::uint8_t>(v);
    std::uint8_t* to = swapped.data() + row_bytes * static_cast<std::size_t>(v);
    for (std::size_t i = 0; i < row_bytes; i += 2) {
      to[i] = from[i + 1];
      to[i + 1] = from[i];
    }
  }
}

/// Writes one camera's folder. Rows wait until their images are surely on the disk.
class CameraFolder {
 public:
  CameraFolder(fs::path folder, const DiskCalls& disk)
      : folder_(std::move(folder)), disk_(disk), waiting_(kTimestampsHeader) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw OutputError(folder_.string() + ": cannot be made: " + error.message());
    const fs::path csv = folder_ / "timestamps.csv";
    csv_ = open(csv.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (csv_ < 0) Fail(csv);
    Append();
  }
  ~CameraFolder() {
    if (csv_ >= 0) close(csv_);
  }
  CameraFolder(const CameraFolder&) = delete;
  CameraFolder& operator=(const CameraFolder&) = delete;

  void WriteImage(const Frame& frame) {
    const ImageView image = frame.image.View();
    if (kind_.width_px == 0) kind_ = {nullptr, image.width_px, image.height_px, 0, image.type};
    RequireSameImages(folder_.parent_path().string(), folder_.filename().string(), kind_, image);
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%06lld.pgm", static_cast<long long>(frame.index));
    const fs::path file = folder_ / name.data(), part = folder_ / ".part";
    const int fd = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) Fail(part);
    const bool written = WritePgm(fd, image);
    const int error = errno;
    close(fd);
    errno = error;
    if (!written || std::rename(part.c_str(), file.c_str()) != 0) Fail(file);
  }
  void AddRow(const Frame& frame, std::int64_t pair) {
    rows_ += TimestampsRow({frame.index, frame.timestamp_ns, frame.exposure_us, pair});
  }
  /// Sets apart what was added. Under the lock that guards `AddRow`.
  void TakeRows() {
    waiting_ += rows_;
    rows_.clear();
  }
  /// Appends what was set apart. After a failure it is as if nothing of it had been written, and
  /// may be tried again: a row that is cut would make the whole take unreadable.
  void Append() {
    if (waiting_.empty()) return;
    const auto bytes = static_cast<std::int64_t>(waiting_.size());
    const bool done = disk_.sync_all(csv_) == 0 &&
                      WriteAt(disk_, csv_, waiting_.data(), bytes, csv_bytes_) &&
                      disk_.sync(csv_) == 0;
    if (!done) {
      const int error = errno;
      // Refused: a cut row stays, and the reader leaves it out.
      static_cast<void>(ftruncate(csv_, csv_bytes_) == 0);
      errno = error;
      Fail(folder_ / "timestamps.csv");
    }
    csv_bytes_ += bytes;
    waiting_.clear();
  }

 private:
  bool WritePgm(int fd, const ImageView& image) {
    const bool is_8_bit = image.type == PixelType::kGray8;
    const std::string header = "P5\n" + std::to_string(image.width_px) + " " +
                               std::to_string(image.height_px) +
                               (is_8_bit ? "\n255\n" : "\n65535\n");
    const auto header_bytes = static_cast<std::int64_t>(header.size());
    if (!WriteAt(disk_, fd, header.data(), header_bytes, 0)) return false;
    if (is_8_bit) return WriteImageAt(disk_, fd, image, header_bytes);
    SwapBytes(image, swapped_);
    return WriteAt(disk_, fd, swapped_.data(), static_cast<std::int64_t>(swapped_.size()),
                   header_bytes);
  }

  const fs::path folder_;
  const DiskCalls& disk_;
  int csv_ = -1;
  std::int64_t csv_bytes_ = 0;
  std::vector<std::uint8_t> swapped_;
  ImageView kind_;       // of the first image, without its pixels
  std::string waiting_;  // not in the file yet
  std::string rows_;     // added since
};

class FolderStore : public FrameStore {
 public:
  FolderStore(const RecorderOptions& options, DiskCalls disk) : disk_(std::move(disk)) {
    lock_.Take(options.output);  // before anything that is there is replaced
    PrepareFolders(options.output, {options.names[0], options.names[1]}, options.overwrite);
    std::error_code error;
    fs::create_directories(options.output, error);
    if (error) throw OutputError(options.output.string() + ": cannot be made: " + error.message());
    lock_.Take(options.output);
    for (std::size_t side = 0; side < 2; ++side) {
      cameras_[side] = std::make_unique<CameraFolder>(options.output / options.names[side], disk_);
    }
  }
  int writers() const override { return 1; }  // so the rows stand in order
  RingPlace Reserve(const RingItem&) override { return {}; }
  void Write(const RingItem& item, const RingPlace&) override {
    for (std::size_t side = 0; side < 2; ++side) {
      if (item.frames[side]) cameras_[side]->WriteImage(*item.frames[side]);
    }
    const std::lock_guard lock(mutex_);
    for (std::size_t side = 0; side < 2; ++side) {
      if (item.frames[side]) cameras_[side]->AddRow(*item.frames[side], item.pair);
    }
  }
  void Flush() override {
    {
      // Together, so that no pair is cut in two by a flush.
      const std::lock_guard lock(mutex_);
      for (auto& camera : cameras_) camera->TakeRows();
    }
    for (auto& camera : cameras_) camera->Append();
  }
  void Close(bool) override { Flush(); }

 private:
  const DiskCalls disk_;
  FolderLock lock_;
  std::array<std::unique_ptr<CameraFolder>, 2> cameras_;
  std::mutex mutex_;  // guards the rows that are added
};

}  // namespace

std::unique_ptr<FrameStore> MakeFolderStore(const RecorderOptions& options, const DiskCalls& disk) {
  return std::make_unique<FolderStore>(options, disk);
}

}  // namespace stereomotion
