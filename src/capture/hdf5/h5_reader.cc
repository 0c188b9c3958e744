#include "h5_reader.h"

#include <algorithm>
#include <array>
#include <limits>

#include "seal.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

constexpr int kImageRank = 3;
// Beyond these a file is damaged: no camera has such images, no take so many.
constexpr hsize_t kMostPixelsOfASide = 1 << 16;
constexpr hsize_t kMostFrames = 1 << 28;
// Deflate makes 1032 equal bytes one at best; what says that it holds more is damaged.
constexpr double kStrongestCompression = 1100;

using Sizes = std::vector<hsize_t>;

Sizes SizesOf(const H5Handle& dataset) {
  const H5Handle space(H5Dget_space(dataset.id()));
  const int rank = space ? H5Sget_simple_extent_ndims(space.id()) : -1;
  if (rank < 0) return {};
  Sizes sizes(static_cast<std::size_t>(rank));
  if (H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr) < 0) return {};
  return sizes;
}

std::string Spelled(const Sizes& sizes) {
  std::string text = "[";
  for (const hsize_t size : sizes) text += (text.size() > 1 ? ", " : "") + std::to_string(size);
  return text + "]";
}

std::string Spelled(const H5Handle& type) {
  const H5T_class_t kind = H5Tget_class(type.id());
  const std::string bits = std::to_string(8 * H5Tget_size(type.id())) + "-bit ";
  if (kind == H5T_FLOAT) return bits + "floating-point numbers";
  if (kind != H5T_INTEGER) return "something that is no number";
  return bits + (H5Tget_sign(type.id()) == H5T_SGN_NONE ? "unsigned" : "signed") + " integers";
}

herr_t CollectName(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

bool IsVirtual(const H5Handle& dataset) {
  const H5Handle list(H5Dget_create_plist(dataset.id()));
  return H5Pget_layout(list.id()) == H5D_VIRTUAL;
}

// Only then the bytes of the file are those of the images.
std::int64_t PlainOffset(const H5Handle& dataset, const H5Handle& type, PixelType pixels) {
  const H5Handle list(H5Dget_create_plist(dataset.id()));
  const hid_t native = pixels == PixelType::kGray8 ? H5T_NATIVE_UINT8 : H5T_NATIVE_UINT16;
  if (H5Pget_layout(list.id()) != H5D_CONTIGUOUS || H5Pget_external_count(list.id()) != 0 ||
      H5Tequal(type.id(), native) <= 0) {
    return -1;
  }
  const haddr_t offset = H5Dget_offset(dataset.id());
  return offset == HADDR_UNDEF ? -1 : static_cast<std::int64_t>(offset);
}

}  // namespace

H5Reader::H5Reader(fs::path file) : file_(std::move(file)) {
  std::error_code none;
  if (!fs::exists(file_, none)) throw UserError(file_.string() + ": no such file");
  if (IsSealBroken(file_)) {
    throw UserError(
        file_.string() + ": found damaged contents (the check sum at its end does not " +
        "fit), expected a recording; `stereomotion record --repair` makes it anew from " +
        "its segments");
  }
  const H5Handle access = H5FileAccess();  // closing it would clear what HDF5 has to say
  h5_ = H5Handle(H5Fopen(file_.c_str(), H5F_ACC_RDONLY, access.id()));
  if (!h5_) {
    throw UserError(file_.string() + ": cannot be read as an HDF5 file (" + H5ErrorText() +
                    "), expected a recording");
  }
}

void H5Reader::Fail(const std::string& dataset, const std::string& found,
                    const std::string& expected) const {
  throw UserError(file_.string() + ":" + dataset + ": found " + found + ", expected " + expected);
}

std::vector<std::string> H5Reader::Cameras() const {
  std::vector<std::string> names;
  if (H5Literate(h5_.id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, CollectName, &names) < 0) {
    H5Eclear2(H5E_DEFAULT);
    names.clear();
    H5Literate(h5_.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, CollectName, &names);
  }
  const auto is_no_camera = [&](const std::string& name) { return !Has("/" + name + "/images"); };
  names.erase(std::remove_if(names.begin(), names.end(), is_no_camera), names.end());
  return names;
}

bool H5Reader::Has(const std::string& dataset) const {
  for (std::size_t end = dataset.find('/', 1);; end = dataset.find('/', end + 1)) {
    const std::string part = dataset.substr(0, end);
    const bool there = H5Lexists(h5_.id(), part.c_str(), H5P_DEFAULT) > 0;
    if (!there) H5Eclear2(H5E_DEFAULT);
    if (!there || end == std::string::npos) return there;
  }
}

H5Handle H5Reader::OpenDataset(const std::string& dataset) const {
  H5Handle opened(H5Dopen2(h5_.id(), dataset.c_str(), H5P_DEFAULT));
  if (!opened) Fail(dataset, "nothing that can be read (" + H5ErrorText() + ")", "a dataset");
  return opened;
}

H5Images H5Reader::Images(const std::string& name) const {
  const H5Handle dataset = OpenDataset(name);
  const H5Handle type(H5Dget_type(dataset.id()));
  const Sizes sizes = SizesOf(dataset);
  const bool fits = sizes.size() == kImageRank && sizes[0] <= kMostFrames && sizes[1] > 0 &&
                    sizes[1] <= kMostPixelsOfASide && sizes[2] > 0 &&
                    sizes[2] <= kMostPixelsOfASide;
  if (!fits) Fail(name, "a dataset of size " + Spelled(sizes), "[frames, height, width]");
  const std::size_t bytes = H5Tget_size(type.id());
  if (H5Tget_class(type.id()) != H5T_INTEGER || H5Tget_sign(type.id()) != H5T_SGN_NONE ||
      bytes > 2) {
    Fail(name, Spelled(type), "8- or 16-bit unsigned integers");
  }
  H5Images images{static_cast<std::int64_t>(sizes[0]), static_cast<int>(sizes[2]),
                  static_cast<int>(sizes[1]), bytes == 1 ? PixelType::kGray8 : PixelType::kGray16};
  images.is_virtual = IsVirtual(dataset);
  images.offset = PlainOffset(dataset, type, images.type);
  // What other files hold takes no room here; it has rows here.
  const std::int64_t row_bytes =
      images.is_virtual ? 1 : std::int64_t{images.width_px} * images.height_px;
  RequireRoom(name, images.frames, row_bytes);
  images.grey_bits = ReadGreyBits(dataset, images.type);
  return images;
}

void H5Reader::RequireRoom(const std::string& name, std::int64_t count,
                           std::int64_t row_bytes) const {
  std::error_code error;
  const auto bytes = static_cast<double>(fs::file_size(file_, error));
  if (error || static_cast<double>(count) * static_cast<double>(row_bytes) <=
                   bytes * kStrongestCompression) {
    return;
  }
  Fail(name, std::to_string(count) + " rows in a file of " + std::to_string(bytes) + " bytes",
       "as many as fit into it");
}

void H5Reader::ReadColumn(const std::string& name, std::int64_t count, bool whole, hid_t native,
                          void* values) const {
  const H5Handle dataset = OpenDataset(name);
  const H5Handle type(H5Dget_type(dataset.id()));
  const Sizes sizes = SizesOf(dataset);
  if (sizes != Sizes{static_cast<hsize_t>(count)}) {
    Fail(name, "a dataset of size " + Spelled(sizes),
         "[" + std::to_string(count) + "], a number a frame");
  }
  RequireRoom(name, count, static_cast<std::int64_t>(H5Tget_size(type.id())));
  const H5T_class_t kind = H5Tget_class(type.id());
  const bool fits = kind == H5T_INTEGER || (!whole && kind == H5T_FLOAT);
  if (!fits) Fail(name, Spelled(type), whole ? "64-bit integers" : "numbers");
  if (H5Dread(dataset.id(), native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    Fail(name, "data that cannot be read (" + H5ErrorText() + ")", "a number a frame");
  }
}

std::vector<std::int64_t> H5Reader::Integers(const std::string& dataset, std::int64_t count) const {
  std::vector<std::int64_t> values(static_cast<std::size_t>(count));
  ReadColumn(dataset, count, /*whole=*/true, H5T_NATIVE_INT64, values.data());
  return values;
}

std::vector<double> H5Reader::Numbers(const std::string& dataset, std::int64_t count) const {
  std::vector<double> values(static_cast<std::size_t>(count));
  ReadColumn(dataset, count, /*whole=*/false, H5T_NATIVE_DOUBLE, values.data());
  return values;
}

}  // namespace stereomotion
