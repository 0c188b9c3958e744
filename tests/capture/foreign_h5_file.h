#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <vector>

#include "recorded_frames.h"

namespace stereomotion::testing {

/// As `MakeFrame` makes them.
constexpr hsize_t kFrames = 6, kHeight = 23, kWidth = 37;

/// Says how a foreign program lays out its file.
struct Layout {
  const char* name = "";
  hid_t image_type = 0, time_type = 0, exposure_type = 0;
  bool chunked = false, compressed = false;
};

/// Writes files of the layout of FORMATS.md through the HDF5 library.
class ForeignFile {
 public:
  explicit ForeignFile(std::filesystem::path file)
      : file_(std::move(file)),
        h5_(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
    for (const char* camera : {"cam0", "cam1"}) {
      H5Gclose(H5Gcreate2(h5_, camera, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
  }
  ~ForeignFile() { Close(); }
  ForeignFile(const ForeignFile&) = delete;
  ForeignFile& operator=(const ForeignFile&) = delete;
  void Close() {
    if (h5_ >= 0) H5Fclose(h5_);
    h5_ = -1;
  }

  template <class T>
  void Add(const std::string& name, hid_t type, hid_t native, std::vector<hsize_t> size,
           const std::vector<T>& values, const Layout& layout = {}) const {
    const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
    const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    size[0] = 2;
    if (layout.chunked) H5Pset_chunk(list, static_cast<int>(size.size()), size.data());
    if (layout.compressed) H5Pset_deflate(list, 4);
    const hid_t dataset =
        H5Dcreate2(h5_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
    H5Dwrite(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(list);
    H5Sclose(space);
  }
  void AddImages(int camera, const Layout& layout) const {
    const bool is_8_bit = H5Tget_size(layout.image_type) == 1;
    const PixelType type = is_8_bit ? PixelType::kGray8 : PixelType::kGray16;
    std::vector<std::uint8_t> bytes;
    for (hsize_t i = 0; i < kFrames; ++i) {
      const auto frame = MakeFrame(camera, static_cast<std::int64_t>(i), type);
      for (int v = 0; v < static_cast<int>(kHeight); ++v) {
        const auto* row = frame->image.View().Row<std::uint8_t>(v);
        bytes.insert(bytes.end(), row, row + kWidth * (is_8_bit ? 1 : 2));
      }
    }
    Add("/cam" + std::to_string(camera) + "/images", layout.image_type,
        is_8_bit ? H5T_NATIVE_UINT8 : H5T_NATIVE_UINT16, {kFrames, kHeight, kWidth}, bytes, layout);
  }
  void AddCamera(int camera, const Layout& layout) const {
    const std::string group = "/cam" + std::to_string(camera) + "/";
    std::vector<std::int64_t> numbers, times;
    std::vector<double> exposures;
    for (hsize_t i = 0; i < kFrames; ++i) {
      const auto frame = MakeFrame(camera, static_cast<std::int64_t>(i));
      numbers.push_back(frame->index);
      times.push_back(frame->timestamp_ns);
      exposures.push_back(frame->exposure_us);
    }
    AddImages(camera, layout);
    Add(group + "frame", H5T_STD_I32LE, H5T_NATIVE_INT64, {kFrames}, numbers, layout);
    Add(group + "timestamp_ns", layout.time_type, H5T_NATIVE_INT64, {kFrames}, times, layout);
    if (layout.exposure_type != 0) {
      Add(group + "exposure_us", layout.exposure_type, H5T_NATIVE_DOUBLE, {kFrames}, exposures,
          layout);
    }
  }

 private:
  std::filesystem::path file_;
  hid_t h5_;
};

}  // namespace stereomotion::testing
