#include "h5_images.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "disk_calls.h"
#include "recording_lock.h"
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
  const H5Reader reader(LinkedFile(file));  // HDF5 looks beside it for others
  shape_ = reader.Images(dataset);
  if (shape_.offset >= 0) {
    sources_.push_back({file, "", shape_.frames});
    for (std::int64_t i = 0; i < shape_.frames; ++i) {
      places_.push_back({0, shape_.offset + i * BytesOf(shape_)});
    }
  } else if (shape_.is_virtual) {
    LocateRuns(reader.Runs(dataset));
  }
  if (places_.empty()) dataset_ = reader.OpenDataset(dataset);
}

H5ImageReader::~H5ImageReader() {
  const H5Lock lock;
  dataset_ = H5Handle();
}

// Whatever HDF5 does not find it reads as black images, and a circle of virtual datasets breaks it.
// So it reads only what is made of whole datasets of other kinds.
void H5ImageReader::LocateRuns(const std::vector<H5Run>& runs) {
  places_.resize(static_cast<std::size_t>(shape_.frames));
  bool is_direct = true;
  for (const H5Run& run : runs) is_direct = LocateRun(run) && is_direct;
  std::string problem = runs.empty() ? "a virtual dataset of nothing" : "";
  bool any = false;
  for (const Source& source : sources_) {
    any = any || source.problem.empty();
    if (problem.empty()) problem = source.problem;
  }
  if ((!is_direct && !problem.empty()) || !any) {
    throw UserError(name_ + ": has no images: found " + problem +
                    ", expected the files that it is made of");
  }
  if (!is_direct) places_.clear();
}

// False: these can be read, but only by HDF5.
bool H5ImageReader::LocateRun(const H5Run& run) {
  H5Images there;
  Source source{run.file, "", run.count};
  try {
    there = H5Reader(run.file).Images(run.dataset);
    if (there.is_virtual) source.problem = run.file.string() + " with a virtual dataset again";
  } catch (const UserError& error) {
    source.problem = error.what();
  }
  // Of an unusual one HDF5 knows what to make.
  const bool fits =
      run.count == 0 ||
      (there.type == shape_.type && there.width_px == shape_.width_px &&
       there.height_px == shape_.height_px && run.in_file + run.count <= there.frames &&
       run.first + run.count <= shape_.frames);
  if (source.problem.empty() && !fits) source.problem = run.file.string() + " with other images";
  const bool is_direct = !source.problem.empty() || (there.offset >= 0 && run.count > 0);
  sources_.push_back(std::move(source));
  const std::int64_t end = std::min(run.first + run.count, shape_.frames);
  for (std::int64_t row = run.first; row < end; ++row) {
    places_[static_cast<std::size_t>(row)] = {
        static_cast<std::int32_t>(sources_.size()) - 1,
        there.offset + (run.in_file + row - run.first) * BytesOf(shape_)};
  }
  return is_direct;
}

std::string H5ImageReader::Missing() const {
  std::int64_t frames = 0;
  std::string first;
  for (const Source& source : sources_) {
    if (source.problem.empty()) continue;
    frames += source.frames;
    if (first.empty()) first = source.problem;
  }
  if (first.empty()) return "";
  return name_ + ": " + std::to_string(frames) + " images are missing; the first: " + first;
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
  if (place.source < 0) return "no image is recorded for this row";
  const Source& source = sources_[static_cast<std::size_t>(place.source)];
  if (!source.problem.empty()) return source.problem;
  const fs::path& file = source.file;
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
