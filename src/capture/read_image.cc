#include "stereomotion/capture/read_image.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "check_image_bytes.h"

namespace stereomotion {
namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(const std::filesystem::path& file)
      : fd_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~FileDescriptor() {
    if (fd_ >= 0) close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

std::string Fail(Image& image, const std::string& reason) {
  image.Resize(0, 0, PixelType::kGray8);
  return reason;
}

int MatType(PixelType type) { return type == PixelType::kGray8 ? CV_8UC1 : CV_16UC1; }

// Offers the decoder the memory of the last image: of the same size, it decodes in place.
cv::Mat WrapMemory(Image& image) {
  if (image.empty()) return {};
  const ImageView view = image.View();
  return {view.height_px, view.width_px, MatType(view.type), image.Row<std::uint8_t>(0),
          static_cast<std::size_t>(view.stride_bytes)};
}

void CopyInto(const cv::Mat& decoded, Image& image) {
  const bool gray8 = decoded.type() == CV_8UC1;
  image.Resize(decoded.cols, decoded.rows, gray8 ? PixelType::kGray8 : PixelType::kGray16);
  const std::size_t row_bytes = static_cast<std::size_t>(decoded.cols) * decoded.elemSize();
  for (int v = 0; v < decoded.rows; ++v) {
    std::memcpy(image.Row<std::uint8_t>(v), decoded.ptr(v), row_bytes);
  }
}

// The decoders' own chatter on stderr names no file; every failure is reported as the frame's.
void SilenceDecoders() {
  static const bool silenced = [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return true;
  }();
  static_cast<void>(silenced);
}

}  // namespace

std::string ReadBytes(const std::filesystem::path& file, std::vector<std::uint8_t>& bytes) {
  const FileDescriptor descriptor(file);
  struct stat info {};
  if (descriptor.get() < 0 || fstat(descriptor.get(), &info) != 0) return std::strerror(errno);
  bytes.resize(static_cast<std::size_t>(info.st_size));
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t n = read(descriptor.get(), bytes.data() + filled, bytes.size() - filled);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return std::strerror(errno);
    if (n == 0) break;
    filled += static_cast<std::size_t>(n);
  }
  bytes.resize(filled);
  return "";
}

std::string DecodeImage(const std::vector<std::uint8_t>& bytes, Image& image) {
  SilenceDecoders();
  if (const std::string wrong = CheckImageBytes(bytes); !wrong.empty()) return Fail(image, wrong);
  cv::Mat decoded = WrapMemory(image);
  const std::uint8_t* reused = decoded.data;
  try {
    constexpr int kFlags =
        cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
    decoded = cv::imdecode(bytes, kFlags, &decoded);
  } catch (const cv::Exception& error) {
    return Fail(image, "cannot be decoded (" + error.err + ")");
  }
  if (decoded.empty()) return Fail(image, "cannot be decoded");
  if (decoded.type() != CV_8UC1 && decoded.type() != CV_16UC1) {
    return Fail(image, "has neither 8- nor 16-bit pixels");
  }
  if (decoded.data != reused) CopyInto(decoded, image);
  return "";
}

bool IsImageFile(const std::filesystem::path& file) {
  static constexpr std::array<const char*, 8> kEndings = {".png", ".tif", ".tiff", ".pgm",
                                                          ".pnm", ".bmp", ".jpg",  ".jpeg"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace stereomotion
