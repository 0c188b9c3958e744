#include "stereomotion/capture/export_recording.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "hdf5/h5_stream.h"
#include "hdf5/prepare_output.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "timestamps_csv.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

void WriteFile(const fs::path& file, const char* data, std::size_t bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(data, static_cast<std::streamsize>(bytes));
  stream.close();
  if (!stream) throw OutputError(file.string() + ": cannot be written; is the disk full?");
}

/// Writes the images of one camera.
class CameraExport {
 public:
  CameraExport(const FrameStream& stream, fs::path folder, std::string extension)
      : stream_(stream), folder_(std::move(folder)), extension_(std::move(extension)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw OutputError(folder_.string() + ": cannot be made: " + error.message());
  }

  void Write(std::int64_t position) {
    const FrameInfo& info = stream_.frames()[static_cast<std::size_t>(position)];
    stream_.ReadImage(position, frame_);
    if (!frame_.problem.empty()) throw UserError(frame_.problem);
    const ImageView image = frame_.image.View();
    const cv::Mat pixels(image.height_px, image.width_px,
                         image.type == PixelType::kGray8 ? CV_8UC1 : CV_16UC1,
                         const_cast<std::uint8_t*>(image.data),  // OpenCV knows no const
                         static_cast<std::size_t>(image.stride_bytes));
    cv::imencode(extension_, pixels, bytes_);
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%06lld", static_cast<long long>(info.index));
    WriteFile(folder_ / (name.data() + extension_), reinterpret_cast<const char*>(bytes_.data()),
              bytes_.size());
    rows_ += TimestampsRow(info);
  }
  void WriteTimes() const {
    const std::string text = kTimestampsHeader + rows_;
    WriteFile(folder_ / "timestamps.csv", text.data(), text.size());
  }

 private:
  const FrameStream& stream_;
  const fs::path folder_;
  const std::string extension_;
  Frame frame_;
  std::vector<std::uint8_t> bytes_;
  std::string rows_;
};

}  // namespace

std::int64_t ExportRecording(const fs::path& recording, const ExportOptions& options,
                             const std::function<void(std::int64_t, std::int64_t)>& step,
                             const std::atomic<bool>* stop) {
  const std::vector<std::string> names = CamerasOfRecording(recording);
  std::vector<std::unique_ptr<FrameStream>> streams;
  std::int64_t all = 0, done = 0;
  for (const std::string& name : names) {
    streams.push_back(OpenH5Stream(recording, name, {}));
    all += static_cast<std::int64_t>(streams.back()->frames().size());
  }
  PrepareFolders(options.output, names, options.overwrite);
  for (std::size_t i = 0; i < names.size(); ++i) {
    CameraExport camera(*streams[i], options.output / names[i], options.extension);
    const auto frames = static_cast<std::int64_t>(streams[i]->frames().size());
    for (std::int64_t frame = 0; frame < frames && !(stop != nullptr && *stop); ++frame) {
      camera.Write(frame);
      ++done;
      if (step) step(done, all);
    }
    camera.WriteTimes();
  }
  return done;
}

}  // namespace stereomotion
