#include "segment_layout.h"

#include "h5_handle.h"
#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

// Images start on a page, so that writing one never touches another's page.
constexpr hsize_t kPageBytes = 4096;

hid_t TypeOf(FrameColumn column) { return column == kExposure ? H5T_IEEE_F64LE : H5T_STD_I64LE; }

// All of its bytes get their place now: that is what makes writing in place possible.
H5Handle EarlyContiguous(H5D_fill_time_t fill) {
  H5Handle list(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_layout(list.id(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(list.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(list.id(), fill);
  return list;
}

class Creator {
 public:
  explicit Creator(const fs::path& file) : file_(file) {
    const H5Handle access = H5FileAccess();
    H5Pset_alignment(access.id(), kPageBytes, kPageBytes);
    h5_ = CreateH5File(file, access);
    Require(static_cast<bool>(h5_));
  }
  SegmentOffsets Add(const SegmentCamera& camera) {
    group_ =
        H5Handle(H5Gcreate2(h5_.id(), camera.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    Require(static_cast<bool>(group_));
    SegmentOffsets offsets;
    const auto frames = static_cast<hsize_t>(camera.capacity);
    for (int i = 0; i < kFrameColumns; ++i) {
      offsets.columns[static_cast<std::size_t>(i)] = AddColumn(static_cast<FrameColumn>(i), frames);
    }
    offsets.synced = AddSynced();
    const H5Handle list = EarlyContiguous(H5D_FILL_TIME_NEVER);
    offsets.images = AddDataset(
        "images", camera.type == PixelType::kGray8 ? H5T_STD_U8LE : H5T_STD_U16LE,
        {frames, static_cast<hsize_t>(camera.height_px), static_cast<hsize_t>(camera.width_px)},
        list);
    const H5Handle images(H5Dopen2(group_.id(), "images", H5P_DEFAULT));
    Require(images && WriteGreyBits(images, camera.grey_bits));
    return offsets;
  }
  void Close() { Require(H5Fflush(h5_.id(), H5F_SCOPE_LOCAL) >= 0); }

 private:
  void Require(bool done) const {
    if (!done) throw OutputError(file_.string() + ": cannot be created: " + H5ErrorText());
  }
  std::int64_t AddColumn(FrameColumn column, hsize_t frames) {
    const H5Handle list = EarlyContiguous(H5D_FILL_TIME_ALLOC);
    if (column == kFrame || column == kPair) {
      H5Pset_fill_value(list.id(), H5T_NATIVE_INT64, &kNoFrame);
    }
    return AddDataset(kColumnNames[column], TypeOf(column), {frames}, list);
  }
  std::int64_t AddSynced() {
    return AddDataset("synced", H5T_STD_I64LE, {1}, EarlyContiguous(H5D_FILL_TIME_ALLOC));
  }
  std::int64_t AddDataset(const char* name, hid_t type, const std::vector<hsize_t>& size,
                          const H5Handle& list) {
    const H5Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
    const H5Handle dataset(
        H5Dcreate2(group_.id(), name, type, space.id(), H5P_DEFAULT, list.id(), H5P_DEFAULT));
    Require(static_cast<bool>(dataset));
    const haddr_t offset = H5Dget_offset(dataset.id());
    Require(offset != HADDR_UNDEF);
    return static_cast<std::int64_t>(offset);
  }

  const fs::path& file_;
  H5Handle h5_, group_;
};

}  // namespace

std::vector<SegmentOffsets> CreateSegment(const fs::path& file,
                                          const std::vector<SegmentCamera>& cameras) {
  const H5Lock lock;
  Creator creator(file);
  std::vector<SegmentOffsets> offsets;
  offsets.reserve(cameras.size());
  for (const SegmentCamera& camera : cameras) offsets.push_back(creator.Add(camera));
  creator.Close();
  return offsets;
}

}  // namespace stereomotion
