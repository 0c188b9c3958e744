#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "disk_calls.h"
#include "h5_handle.h"
#include "joined_camera.h"
#include "recording_lock.h"
#include "seal.h"
#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "stereomotion-recording/1";

// In a name of a virtual dataset's source a percent sign begins a pattern.
std::string Escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

class JoinedWriter {
 public:
  JoinedWriter(const fs::path& file, std::string folder)
      : file_(file), folder_(std::move(folder)), h5_(CreateH5File(file, H5FileAccess())) {
    Require(static_cast<bool>(h5_));
    const H5Handle type(H5Tcopy(H5T_C_S1)), space(H5Screate(H5S_SCALAR));
    H5Tset_size(type.id(), std::strlen(kFormat));
    const H5Handle attribute(
        H5Acreate2(h5_.id(), "format", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT));
    Require(attribute && H5Awrite(attribute.id(), type.id(), kFormat) >= 0);
  }

  void Add(const JoinedCamera& camera) {
    const std::string& name = camera.shape.name;
    group_ = H5Handle(H5Gcreate2(h5_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    Require(static_cast<bool>(group_));
    for (std::size_t i = 0; i < kFrameColumns; ++i) {
      if (i == kExposure) {
        AddColumn(kColumnNames[i], H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, camera.exposure_us);
      } else {
        AddColumn(kColumnNames[i], H5T_STD_I64LE, H5T_NATIVE_INT64, camera.columns[i]);
      }
    }
    AddImages(camera);
  }

  void Close() {
    Require(H5Fflush(h5_.id(), H5F_SCOPE_GLOBAL) >= 0);
    group_ = H5Handle();
    h5_ = H5Handle();
  }

 private:
  void Require(bool done) const {
    if (!done) throw OutputError(file_.string() + ": cannot be written: " + H5ErrorText());
  }
  template <class T>
  void AddColumn(const char* name, hid_t type, hid_t native, const std::vector<T>& values) {
    const hsize_t size = values.size();
    const H5Handle space(H5Screate_simple(1, &size, nullptr));
    const H5Handle dataset(
        H5Dcreate2(group_.id(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    Require(dataset &&
            H5Dwrite(dataset.id(), native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  }
  [[nodiscard]] H5Handle Space(const SegmentCamera& shape, std::int64_t frames, std::int64_t first,
                               std::int64_t count) const {
    const auto height = static_cast<hsize_t>(shape.height_px);
    const auto width = static_cast<hsize_t>(shape.width_px);
    const std::array<hsize_t, 3> size{static_cast<hsize_t>(frames), height, width};
    const std::array<hsize_t, 3> begin{static_cast<hsize_t>(first), 0, 0};
    const std::array<hsize_t, 3> block{static_cast<hsize_t>(count), height, width};
    H5Handle space(H5Screate_simple(3, size.data(), nullptr));
    Require(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr, block.data(),
                                nullptr) >= 0);
    return space;
  }
  void AddImages(const JoinedCamera& camera) {
    const SegmentCamera& shape = camera.shape;
    const H5Handle list(H5Pcreate(H5P_DATASET_CREATE));
    const std::string source = Escaped("/" + shape.name + "/images");
    std::int64_t first = 0;
    for (const SegmentRun& run : camera.runs) {
      const H5Handle here = Space(shape, camera.frames(), first, run.count);
      const H5Handle there = Space(shape, run.capacity, run.first, run.count);
      const std::string file = Escaped(folder_ + "/" + run.file);
      Require(H5Pset_virtual(list.id(), here.id(), file.c_str(), source.c_str(), there.id()) >= 0);
      first += run.count;
    }
    const H5Handle space = Space(shape, camera.frames(), 0, camera.frames());
    const hid_t type = shape.type == PixelType::kGray8 ? H5T_STD_U8LE : H5T_STD_U16LE;
    const H5Handle dataset(
        H5Dcreate2(group_.id(), "images", type, space.id(), H5P_DEFAULT, list.id(), H5P_DEFAULT));
    Require(dataset && WriteGreyBits(dataset, shape.grey_bits));
  }

  const fs::path& file_;
  const std::string folder_;
  H5Handle h5_, group_;
};

void SyncAndRename(const fs::path& part, const fs::path& file) {
  const int fd = open(part.c_str(), O_RDWR | O_CLOEXEC);
  const bool synced = fd >= 0 && fsync(fd) == 0;
  const int error = errno;
  if (fd >= 0) close(fd);
  errno = error;
  if (synced && std::rename(part.c_str(), file.c_str()) == 0) {
    SyncFolderOf(file);
    return;
  }
  throw OutputError(file.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

void WriteJoined(const fs::path& recording, const std::vector<JoinedCamera>& cameras) {
  const fs::path part = recording.string() + ".part";
  try {
    {
      const H5Lock lock;
      JoinedWriter writer(part, SegmentFolder(recording).filename().string());
      for (const JoinedCamera& camera : cameras) {
        if (camera.frames() > 0) writer.Add(camera);
      }
      writer.Close();
    }
    Seal(part);
    SyncAndRename(part, recording);
  } catch (...) {
    unlink(part.c_str());
    throw;
  }
}

}  // namespace stereomotion
