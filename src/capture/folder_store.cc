#include "folder_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "hdf5/prepare_output.h"
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
  CameraFolder(fs::path folder, const DiskCalls& disk) : folder_(std::move(folder)), disk_(disk) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw OutputError(folder_.string() + ": cannot be made: " + error.message());
    const fs::path csv = folder_ / "timestamps.csv";
    csv_ = open(csv.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (csv_ < 0) Fail(csv);
    rows_ = kTimestampsHeader;
    Append();
  }
  ~CameraFolder() { close(csv_); }
  CameraFolder(const CameraFolder&) = delete;
  CameraFolder& operator=(const CameraFolder&) = delete;

  void WriteImage(const Frame& frame) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%06lld.pgm", static_cast<long long>(frame.index));
    const fs::path file = folder_ / name.data(), part = folder_ / ".part";
    const int fd = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) Fail(part);
    const bool written = WritePgm(fd, frame.image.View());
    const int error = errno;
    close(fd);
    errno = error;
    if (!written || std::rename(part.c_str(), file.c_str()) != 0) Fail(file);
  }
  void AddRow(const Frame& frame, std::int64_t pair) {
    const std::lock_guard lock(mutex_);
    rows_ += TimestampsRow({frame.index, frame.timestamp_ns, frame.exposure_us, pair});
  }
  void Append() {
    {
      const std::lock_guard lock(mutex_);
      appended_.swap(rows_);
      rows_.clear();
    }
    if (appended_.empty()) return;
    const fs::path csv = folder_ / "timestamps.csv";
    if (disk_.sync_all(csv_) != 0) Fail(csv);
    const auto bytes = static_cast<std::int64_t>(appended_.size());
    if (!WriteAt(disk_, csv_, appended_.data(), bytes, csv_bytes_) || disk_.sync(csv_) != 0) {
      Fail(csv);
    }
    csv_bytes_ += bytes;
    appended_.clear();
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
  std::string appended_;
  std::mutex mutex_;
  std::string rows_;
};

class FolderStore : public FrameStore {
 public:
  FolderStore(const RecorderOptions& options, DiskCalls disk) : disk_(std::move(disk)) {
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
    for (std::size_t side = 0; side < 2; ++side) {
      if (item.frames[side]) cameras_[side]->AddRow(*item.frames[side], item.pair);
    }
  }
  void Flush() override {
    for (auto& camera : cameras_) camera->Append();
  }
  void Close(bool) override { Flush(); }

 private:
  const DiskCalls disk_;
  std::array<std::unique_ptr<CameraFolder>, 2> cameras_;
};

}  // namespace

std::unique_ptr<FrameStore> MakeFolderStore(const RecorderOptions& options, const DiskCalls& disk) {
  PrepareFolders(options.output, {options.names[0], options.names[1]}, options.overwrite);
  return std::make_unique<FolderStore>(options, disk);
}

}  // namespace stereomotion
