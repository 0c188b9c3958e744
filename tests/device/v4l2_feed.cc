// Plays the two cameras of a recording into two v4l2loopback devices, each image once.
//
// usage: v4l2_feed REC/cam0 /dev/videoA REC/cam1 /dev/videoB RATE_HZ
//
// Waits until another program has mapped the buffers of both devices, plays, and then keeps the
// devices open until it is killed, so that the reader sees the end as silence.

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "stereomotion/capture/recording.h"

namespace {

using stereomotion::FramePair;
using stereomotion::ImageView;

// What a reader needs between mapping its buffers and taking images, on an emulated processor.
constexpr std::chrono::seconds kReaderStarts{2};
constexpr std::chrono::milliseconds kLookAgain{200};

class OutputDevice {
 public:
  OutputDevice(const std::string& path, const ImageView& image)
      : path_(path), descriptor_(open(path.c_str(), O_RDWR)) {
    if (descriptor_ < 0) throw std::runtime_error(path + ": cannot be opened");
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<__u32>(image.width_px);
    format.fmt.pix.height = static_cast<__u32>(image.height_px);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_GREY;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    Control(VIDIOC_S_FMT, &format);
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    Control(VIDIOC_STREAMON, &type);  // from now on a reader finds the format
  }
  ~OutputDevice() { close(descriptor_); }
  OutputDevice(const OutputDevice&) = delete;
  OutputDevice& operator=(const OutputDevice&) = delete;

  void Write(const ImageView& image) {
    bytes_.clear();
    for (int v = 0; v < image.height_px; ++v) {
      const auto* row = image.Row<char>(v);
      bytes_.insert(bytes_.end(), row, row + image.width_px);
    }
    if (write(descriptor_, bytes_.data(), bytes_.size()) != static_cast<ssize_t>(bytes_.size())) {
      throw std::runtime_error(path_ + ": an image was not taken");
    }
  }

  // Whether any program maps the device; this one only writes.
  [[nodiscard]] bool HasReader() const {
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      std::ifstream maps(process.path() / "maps");
      for (std::string line; std::getline(maps, line);) {
        if (line.find(path_) != std::string::npos) return true;
      }
    }
    return false;
  }

 private:
  void Control(std::uint64_t request, void* argument) {
    if (ioctl(descriptor_, request, argument) != 0) {
      throw std::runtime_error(path_ + ": is no v4l2loopback device, or in use");
    }
  }

  std::string path_;
  int descriptor_;
  std::vector<char> bytes_;
};

void Feed(char** arguments) {
  const auto recording = stereomotion::OpenRecording(arguments[1], arguments[3]);
  std::vector<FramePair> pairs(static_cast<std::size_t>(recording->size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    recording->Read(static_cast<std::int64_t>(i), pairs[i]);
  }
  OutputDevice left(arguments[2], pairs.at(0).left.image.View());
  OutputDevice right(arguments[4], pairs.at(0).right.image.View());
  std::cout << "feed: ready" << std::endl;
  while (!left.HasReader() || !right.HasReader()) std::this_thread::sleep_for(kLookAgain);
  std::this_thread::sleep_for(kReaderStarts);
  const std::chrono::duration<double> period(1 / std::atof(arguments[5]));
  auto due = std::chrono::steady_clock::now();
  for (const FramePair& pair : pairs) {
    std::this_thread::sleep_until(due);
    left.Write(pair.left.image.View());
    right.Write(pair.right.image.View());
    due += std::chrono::duration_cast<std::chrono::steady_clock::duration>(period);
  }
  std::cout << "feed: done" << std::endl;
  pause();
}

}  // namespace

int main(int count, char** arguments) {
  constexpr int kArguments = 6;
  if (count != kArguments) {
    std::cerr << "usage: v4l2_feed REC/cam0 /dev/videoA REC/cam1 /dev/videoB RATE_HZ\n";
    return 2;
  }
  try {
    Feed(arguments);
  } catch (const std::exception& error) {
    std::cerr << "v4l2_feed: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
