#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Keeps all other threads out of the HDF5 library, which distributions build without thread
/// safety: whoever calls it holds one of these. Its own printing of errors is switched off.
class H5Lock {
 public:
  H5Lock();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Owns one HDF5 identifier of any kind. Made, used and destroyed under an `H5Lock`.
class H5Handle {
 public:
  H5Handle() = default;
  explicit H5Handle(hid_t id) : id_(id) {}
  ~H5Handle();
  H5Handle(H5Handle&& other) noexcept : id_(other.id_) { other.id_ = H5I_INVALID_HID; }
  H5Handle& operator=(H5Handle&& other) noexcept;
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;

  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

/// Tells in HDF5's own words why its last call failed, innermost cause first.
std::string H5ErrorText();

/// Makes the access list with which all files are opened: HDF5's own file locks are off, for they
/// fail on read-only and network disks; a recording has a lock of its own.
H5Handle H5FileAccess();

/// Notes how many bits a grey value of a dataset of images has (`ImageView::grey_bits`; 0: nothing
/// is noted).
bool WriteGreyBits(const H5Handle& images, int bits);
/// Reads that note; 0 where there is none that fits the images.
int ReadGreyBits(const H5Handle& images, PixelType type);

/// Creates a file that keeps its groups, the cameras, in the order in which they are made.
H5Handle CreateH5File(const std::string& file, const H5Handle& access);

}  // namespace stereomotion
