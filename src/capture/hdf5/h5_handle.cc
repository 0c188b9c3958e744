#include "h5_handle.h"

namespace stereomotion {
namespace {

constexpr const char* kGreyBits = "grey_bits";

// The library is one for the whole process, so its lock must be, too.
std::recursive_mutex& LibraryMutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

// Walking upwards the first is the call that failed, the last the one that was asked.
herr_t KeepFirst(unsigned level, const H5E_error2_t* error, void* text) {
  if (level == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

}  // namespace

H5Lock::H5Lock() : lock_(LibraryMutex()) {
  // At a program's exit HDF5 would close what it could not close before, on a full disk, and crash.
  [[maybe_unused]] static const herr_t before_any_other_call = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

H5Handle::~H5Handle() {
  if (id_ >= 0) H5Idec_ref(id_);
}

H5Handle& H5Handle::operator=(H5Handle&& other) noexcept {
  if (this == &other) return *this;
  if (id_ >= 0) H5Idec_ref(id_);
  id_ = other.id_;
  other.id_ = H5I_INVALID_HID;
  return *this;
}

std::string H5ErrorText() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, KeepFirst, &text);
  H5Eclear2(H5E_DEFAULT);
  return text.empty() ? "HDF5 does not say why" : text;
}

H5Handle H5FileAccess() {
  H5Handle access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access.id(), /*use_file_locking=*/false, /*ignore_when_disabled=*/true);
  return access;
}

bool WriteGreyBits(const H5Handle& images, int bits) {
  if (bits == 0) return true;
  const H5Handle space(H5Screate(H5S_SCALAR));
  const H5Handle attribute(
      H5Acreate2(images.id(), kGreyBits, H5T_STD_I32LE, space.id(), H5P_DEFAULT, H5P_DEFAULT));
  return attribute && H5Awrite(attribute.id(), H5T_NATIVE_INT, &bits) >= 0;
}

int ReadGreyBits(const H5Handle& images, PixelType type) {
  if (H5Aexists(images.id(), kGreyBits) <= 0) return 0;
  const H5Handle attribute(H5Aopen(images.id(), kGreyBits, H5P_DEFAULT));
  const H5Handle space(H5Aget_space(attribute.id()));
  const H5Handle stored(H5Aget_type(attribute.id()));
  const bool is_number =
      H5Tget_class(stored.id()) == H5T_INTEGER && H5Sget_simple_extent_npoints(space.id()) == 1;
  int bits = 0;
  if (!is_number || H5Aread(attribute.id(), H5T_NATIVE_INT, &bits) < 0) return 0;
  const int most = type == PixelType::kGray8 ? 8 : 16;
  return bits > 0 && bits <= most ? bits : 0;
}

H5Handle CreateH5File(const std::string& file, const H5Handle& access) {
  const H5Handle creation(H5Pcreate(H5P_FILE_CREATE));
  H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  // From this format on HDF5 keeps check sums of most of its own structures.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  return H5Handle(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()));
}

}  // namespace stereomotion
