#include "stereomotion/simulation/write_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "stereomotion/simulation/render_scene.h"
#include "truth_text.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

/// Writes beside the file and renames: an interrupted run leaves no half file under its name.
void WriteBytes(const fs::path& file, const char* data, std::size_t size) {
  const fs::path part = file.string() + ".part";
  std::ofstream stream(part, std::ios::binary | std::ios::trunc);
  stream.write(data, static_cast<std::streamsize>(size));
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
  fs::rename(part, file);
}

void WriteText(const fs::path& file, const std::string& text) {
  WriteBytes(file, text.data(), text.size());
}

void WritePng(const fs::path& file, const Image& image) {
  const ImageView view = image.View();
  const cv::Mat mat(view.height_px, view.width_px,
                    view.type == PixelType::kGray8 ? CV_8UC1 : CV_16UC1,
                    const_cast<std::uint8_t*>(view.data),  // cv::Mat has no const view
                    static_cast<std::size_t>(view.stride_bytes));
  std::vector<unsigned char> bytes;
  cv::imencode(
      ".png", mat, bytes,
      {cv::IMWRITE_PNG_COMPRESSION, 6, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_DEFAULT});
  WriteBytes(file, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void CheckNames(const Scenario& scenario) {
  const std::string& left = scenario.rig.cameras[0].name;
  const std::string& right = scenario.rig.cameras[1].name;
  for (const std::string& name : {left, right}) {
    const fs::path path(name);
    if (name.empty() || path.filename() != path || name == "." || name == ".." || name == "truth") {
      throw std::invalid_argument("scenario: camera name '" + name + "' cannot name a folder");
    }
  }
  if (left == right) throw std::invalid_argument("scenario: both cameras have the same name");
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": " + error.message());
}

/// Hands frames to threads one by one and keeps the first exception.
class FrameLoop {
 public:
  FrameLoop(const Scenario& scenario, const fs::path& folder, const WriteRecordingOptions& options)
      : scenario_(scenario), folder_(folder), options_(options) {}

  std::int64_t Run() {
    const int wanted = options_.threads > 0 ? options_.threads
                                            : static_cast<int>(std::thread::hardware_concurrency());
    std::vector<std::thread> threads;
    for (int i = 1; i < std::min(wanted, scenario_.frames); ++i) {
      threads.emplace_back([this] { Work(); });
    }
    Work();
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    return done_;
  }

 private:
  void Work() {
    Image image;
    try {
      for (int frame = next_++; frame < scenario_.frames && !Stopped(); frame = next_++) {
        WriteFrame(frame, image);
        const std::lock_guard<std::mutex> lock(mutex_);
        ++done_;
        if (options_.on_progress) options_.on_progress(done_, scenario_.frames);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = scenario_.frames;
    }
  }

  void WriteFrame(int frame, Image& image) const {
    for (const int camera : {0, 1}) {
      RenderSceneImage(scenario_, camera, frame, image);
      WritePng(folder_ / scenario_.rig.cameras[camera].name / fmt::format("{:06}.png", frame),
               image);
    }
  }

  [[nodiscard]] bool Stopped() const { return options_.stop != nullptr && *options_.stop; }

  const Scenario& scenario_;
  const fs::path& folder_;
  const WriteRecordingOptions& options_;
  std::atomic<int> next_{0};
  std::mutex mutex_;
  std::int64_t done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::int64_t WriteRecording(const Scenario& scenario, const fs::path& folder,
                            const WriteRecordingOptions& options) {
  CheckScenario(scenario);
  CheckNames(scenario);
  for (const int camera : {0, 1}) {
    const fs::path camera_folder = folder / scenario.rig.cameras[camera].name;
    MakeFolder(camera_folder);
    WriteText(camera_folder / "timestamps.csv", TimestampsCsv(scenario, camera));
  }
  MakeFolder(folder / "truth");
  WriteText(folder / "truth" / "poses.csv", TruePosesCsv(scenario));
  WriteText(folder / "truth" / "balls.csv", TrueBallsCsv(scenario));
  WriteText(folder / "truth" / "scene.json", SceneJson(scenario));
  return FrameLoop(scenario, folder, options).Run();
}

}  // namespace stereomotion
