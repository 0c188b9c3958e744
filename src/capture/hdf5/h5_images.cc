#include "h5_images.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "disk_calls.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

std::int64_t BytesOf(const H5Images& shape) {
  return static_cast<std::int64_t>(shape.width_px) * shape.height_px *
         (shape.type == PixelType::kGray8 ? 1 : 2);
}

}  // namespace

H5ImageReader::H5ImageReader(const fs::path& file, const std::string& dataset)
    : name_(file.string() + ":" + dataset) {
  const H5Reader reader(file);
  shape_ = reader.Images(dataset);
  const std::vector<H5Run> runs = reader.Runs(dataset);
  if (shape_.offset >= 0) {
    files_ = {file};
    for (std::int64_t i = 0; i < shape_.frames; ++i) {
      places_.push_back({0, shape_.offset + i * BytesOf(shape_)});
    }
  } else if (!runs.empty()) {
    places_.resize(static_cast<std::size_t>(shape_.frames));
    for (const H5Run& run : runs) {
      if (LocateRun(run)) continue;
      places_.clear();  // an unusual virtual dataset: HDF5 knows what to make of it
      break;
    }
  }
  if (places_.empty()) dataset_ = reader.OpenDataset(dataset);
}

H5ImageReader::~H5ImageReader() {
  const H5Lock lock;
  dataset_ = H5Handle();
}

bool H5ImageReader::LocateRun(const H5Run& run) {
  const H5Reader reader(run.file);
  const H5Images there = reader.Images(run.dataset);
  const bool fits = there.offset >= 0 && there.type == shape_.type &&
                    there.width_px == shape_.width_px && there.height_px == shape_.height_px &&
                    run.in_file + run.count <= there.frames &&
                    run.first + run.count <= shape_.frames;
  if (!fits) return false;
  if (files_.empty() || files_.back() != run.file) files_.push_back(run.file);
  for (std::int64_t i = 0; i < run.count; ++i) {
    places_[static_cast<std::size_t>(run.first + i)] = {
        static_cast<std::int32_t>(files_.size()) - 1,
        there.offset + (run.in_file + i) * BytesOf(shape_)};
  }
  return true;
}

std::string H5ImageReader::Read(std::int64_t position, Image& image) const {
  const std::string problem =
      places_.empty() ? ReadThroughHdf5(position, image)
                      : ReadDirectly(places_[static_cast<std::size_t>(position)], image);
  if (problem.empty()) {
    image.SetGreyBits(shape_.grey_bits);
    return "";
  }
  image.Resize(0, 0, PixelType::kGray8);
  return name_ + "[" + std::to_string(position) + "]: " + problem;
}

std::string H5ImageReader::ReadDirectly(const Place& place, Image& image) const {
  if (place.file < 0) return "no image is recorded for this row";
  const fs::path& file = files_[static_cast<std::size_t>(place.file)];
  // Opened for each image: a long recording has more files than a program may hold open.
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return file.string() + " cannot be opened: " + std::strerror(errno);
  const bool done =
      ReadImageAt(fd, shape_.width_px, shape_.height_px, shape_.type, place.offset, image);
  const int error = errno;
  close(fd);
  if (done) return "";
  return file.string() + " cannot be read: " +
         (error != 0 ? std::strerror(error) : "it ends before the image does");
}

std::string H5ImageReader::ReadThroughHdf5(std::int64_t position, Image& image) const {
  constexpr int kRank = 3;
  const auto height = static_cast<hsize_t>(shape_.height_px);
  const auto width = static_cast<hsize_t>(shape_.width_px);
  image.Resize(shape_.width_px, shape_.height_px, shape_.type);
  const bool is_8_bit = shape_.type == PixelType::kGray8;
  const auto stride = static_cast<hsize_t>(image.View().stride_bytes / (is_8_bit ? 1 : 2));
  const std::array<hsize_t, kRank> first{static_cast<hsize_t>(position), 0, 0};
  const std::array<hsize_t, kRank> one{1, height, width}, padded{1, height, stride}, zero{};
  const H5Lock lock;
  const H5Handle there(H5Dget_space(dataset_.id()));
  const H5Handle here(H5Screate_simple(kRank, padded.data(), nullptr));
  const bool done = H5Sselect_hyperslab(there.id(), H5S_SELECT_SET, first.data(), nullptr,
                                        one.data(), nullptr) >= 0 &&
                    H5Sselect_hyperslab(here.id(), H5S_SELECT_SET, zero.data(), nullptr, one.data(),
                                        nullptr) >= 0 &&
                    H5Dread(dataset_.id(), is_8_bit ? H5T_NATIVE_UINT8 : H5T_NATIVE_UINT16,
                            here.id(), there.id(), H5P_DEFAULT, image.Row<std::uint8_t>(0)) >= 0;
  return done ? "" : H5ErrorText();
}

}  // namespace stereomotion
