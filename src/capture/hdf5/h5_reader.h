#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "h5_handle.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Tells what a dataset of images is like.
struct H5Images {
  std::int64_t frames = 0;
  int width_px = 0, height_px = 0;
  PixelType type = PixelType::kGray8;
  /// Where the first image lies in the file, row by row without gaps in this machine's byte order;
  /// −1: it has to be read through HDF5 (chunked, compressed, other byte order, virtual).
  std::int64_t offset = -1;
  int grey_bits = 0;        ///< attribute `grey_bits`; 0: not told
  bool is_virtual = false;  ///< made of datasets elsewhere (`H5Reader::Runs`)
};

/// Says from which file a run of frames of a virtual dataset comes. `count` is 0 where they are not
/// whole frames in order.
struct H5Run {
  std::filesystem::path file;
  std::string dataset;
  std::int64_t first = 0;    ///< in the virtual dataset
  std::int64_t in_file = 0;  ///< place of that frame in `file`
  std::int64_t count = 0;
};

/// Reads an HDF5 file of the layout of docs/formats.md. Whatever is not as it says is a `UserError`
/// that names file and dataset. Used under an `H5Lock`.
class H5Reader {
 public:
  explicit H5Reader(std::filesystem::path file);

  /// Lists the groups that hold `images`: in the order of their creation, else by name.
  [[nodiscard]] std::vector<std::string> Cameras() const;
  [[nodiscard]] bool Has(const std::string& dataset) const;
  [[nodiscard]] H5Images Images(const std::string& name) const;
  /// Reads whole numbers; there must be `count`.
  [[nodiscard]] std::vector<std::int64_t> Integers(const std::string& dataset,
                                                   std::int64_t count) const;
  /// Reads numbers, whole or not.
  [[nodiscard]] std::vector<double> Numbers(const std::string& dataset, std::int64_t count) const;
  /// Lists what a virtual dataset of images is made of.
  [[nodiscard]] std::vector<H5Run> Runs(const std::string& name) const;
  [[nodiscard]] H5Handle OpenDataset(const std::string& dataset) const;
  [[noreturn]] void Fail(const std::string& dataset, const std::string& found,
                         const std::string& expected) const;

 private:
  // Throws `UserError` where a dataset says that it has more rows than can be in the file.
  void RequireRoom(const std::string& name, std::int64_t count, std::int64_t row_bytes) const;
  void ReadColumn(const std::string& name, std::int64_t count, bool whole, hid_t native,
                  void* values) const;

  std::filesystem::path file_;
  H5Handle h5_;
};

}  // namespace stereomotion
