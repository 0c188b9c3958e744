#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "h5_reader.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// Reads the images of one camera of a recording file from any thread: straight from the file where
/// they lie there as they are, else through HDF5, one at a time.
class H5ImageReader {
 public:
  /// `dataset`: "/cam0/images". Throws `UserError`. Under an `H5Lock`.
  H5ImageReader(const std::filesystem::path& file, const std::string& dataset);
  ~H5ImageReader();
  H5ImageReader(const H5ImageReader&) = delete;
  H5ImageReader& operator=(const H5ImageReader&) = delete;

  [[nodiscard]] const H5Images& shape() const { return shape_; }
  /// Reads one image; an empty text, or why it failed (then `image` is empty).
  [[nodiscard]] std::string Read(std::int64_t position, Image& image) const;
  /// True: the images are read without HDF5.
  [[nodiscard]] bool is_direct() const { return !places_.empty(); }
  /// Tells for a person what of a virtual dataset is missing; empty: nothing.
  [[nodiscard]] std::string Missing() const;

 private:
  struct Place {
    std::int32_t source = -1;  ///< in `sources_`; −1: no image is recorded for the row
    std::int64_t offset = 0;
  };
  struct Source {
    std::filesystem::path file;
    std::string problem;      ///< why its images are missing
    std::int64_t frames = 0;  ///< of this recording that come from it
  };
  void LocateRuns(const std::vector<H5Run>& runs);
  bool LocateRun(const H5Run& run);
  std::string ReadDirectly(const Place& place, Image& image) const;
  std::string ReadThroughHdf5(std::int64_t position, Image& image) const;

  std::string name_;
  H5Images shape_;
  std::vector<Source> sources_;
  std::vector<Place> places_;  ///< empty: read through HDF5
  H5Handle dataset_;
};

}  // namespace stereomotion
