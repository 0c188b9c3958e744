#include "join_segments.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

#include "disk_calls.h"
#include "h5_reader.h"
#include "joined_camera.h"
#include "recording_lock.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

/// Adds segment after segment to what is joined.
class Joiner {
 public:
  explicit Joiner(bool trust_all) : trust_all_(trust_all) {}
  /// Returns the number of rows that are valid. Throws `UserError` where it is no segment.
  std::int64_t Add(const fs::path& segment);
  [[nodiscard]] const std::vector<JoinedCamera>& cameras() const { return cameras_; }

 private:
  struct Part {
    SegmentCamera shape;
    std::vector<std::int64_t> rows;  // the valid ones, in order
    std::array<std::vector<std::int64_t>, kFrameColumns> columns;
    std::vector<double> exposure_us;
    std::int64_t image_offset = -1;
    std::int64_t believed = 0;  // rows below may be valid
  };
  [[nodiscard]] Part ReadPart(const H5Reader& reader, const std::string& name) const;
  // `place`: of the camera in its segment, so that left comes first also where it came later.
  void Append(const Part& part, std::size_t place, const std::string& file);
  static void Forget(const H5Reader& reader, const fs::path& segment, const Part& part);
  static void GiveBackTail(const fs::path& segment, const Part& part);

  const bool trust_all_;
  std::vector<JoinedCamera> cameras_;
};

Joiner::Part Joiner::ReadPart(const H5Reader& reader, const std::string& name) const {
  const std::string group = "/" + name + "/";
  const H5Images images = reader.Images(group + "images");
  Part part;
  part.shape = {name,        images.width_px, images.height_px,
                images.type, images.frames,   images.grey_bits};
  part.image_offset = images.offset;
  for (std::size_t i = 0; i < kFrameColumns; ++i) {
    if (i == kExposure) {
      part.exposure_us = reader.Numbers(group + kColumnNames[i], images.frames);
    } else {
      part.columns[i] = reader.Integers(group + kColumnNames[i], images.frames);
    }
  }
  const std::int64_t synced = reader.Integers(group + "synced", 1).front();
  part.believed = trust_all_ ? images.frames : std::min(synced, images.frames);
  for (std::int64_t row = 0; row < part.believed; ++row) {
    if (part.columns[kFrame][static_cast<std::size_t>(row)] >= 0) part.rows.push_back(row);
  }
  return part;
}

void Joiner::Append(const Part& part, std::size_t place, const std::string& file) {
  const auto same_name = [&](const JoinedCamera& one) { return one.shape.name == part.shape.name; };
  auto camera = std::find_if(cameras_.begin(), cameras_.end(), same_name);
  if (camera == cameras_.end()) {
    const auto at =
        cameras_.begin() + static_cast<std::ptrdiff_t>(std::min(place, cameras_.size()));
    camera = cameras_.insert(at, {part.shape, {}, {}, {}});
  }
  if (camera->shape.image_bytes() != part.shape.image_bytes() ||
      camera->shape.width_px != part.shape.width_px) {
    throw UserError(file + ": camera " + part.shape.name + " has images of another size than in " +
                    "the segments before");
  }
  bool is_new_run = true;
  std::int64_t last = -1;
  for (const std::int64_t row : part.rows) {
    const auto at = static_cast<std::size_t>(row);
    for (std::size_t i = 0; i < kFrameColumns; ++i) {
      if (i != kExposure) camera->columns[i].push_back(part.columns[i][at]);
    }
    camera->exposure_us.push_back(part.exposure_us[at]);
    if (is_new_run || row != last + 1) {
      camera->runs.push_back({file, row, 0, part.shape.capacity});
    }
    ++camera->runs.back().count;
    last = row;
    is_new_run = false;
  }
}

// What is not believed now must not be when it is joined again and nothing tells why any more.
void Joiner::Forget(const H5Reader& reader, const fs::path& segment, const Part& part) {
  if (part.believed >= part.shape.capacity) return;
  const H5Handle column = reader.OpenDataset("/" + part.shape.name + "/" + kColumnNames[kFrame]);
  const haddr_t offset = H5Dget_offset(column.id());
  const int fd = offset == HADDR_UNDEF ? -1 : open(segment.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return;
  const std::vector<std::int64_t> none(
      static_cast<std::size_t>(part.shape.capacity - part.believed), kNoFrame);
  WriteAt({}, fd, none.data(), static_cast<std::int64_t>(none.size()) * kCellBytes,
          static_cast<std::int64_t>(offset) + part.believed * kCellBytes);
  close(fd);
}

void Joiner::GiveBackTail(const fs::path& segment, const Part& part) {
  const int fd = part.image_offset < 0 ? -1 : open(segment.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return;
  const std::int64_t used = part.rows.empty() ? 0 : part.rows.back() + 1;
  const std::int64_t bytes = part.shape.image_bytes();
  GiveBackRoom(fd, part.image_offset + used * bytes,
               part.image_offset + part.shape.capacity * bytes);
  close(fd);
}

std::int64_t Joiner::Add(const fs::path& segment) {
  const H5Lock lock;
  const H5Reader reader(segment);
  std::vector<Part> parts;
  for (const std::string& name : reader.Cameras()) parts.push_back(ReadPart(reader, name));
  if (parts.empty()) throw UserError(segment.string() + ": holds no camera, expected a segment");
  std::int64_t rows = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Append(parts[i], i, segment.filename().string());
    Forget(reader, segment, parts[i]);
    GiveBackTail(segment, parts[i]);
    rows += static_cast<std::int64_t>(parts[i].rows.size());
  }
  return rows;
}

// What has no name yet was cut off while it was made.
void RemoveParts(const fs::path& folder) {
  std::vector<fs::path> parts;
  std::error_code error, none;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (IsCutSegment(it->path())) parts.push_back(it->path());
  }
  for (const fs::path& part : parts) fs::remove(part, none);
}

}  // namespace

bool IsSegment(const fs::path& file) {
  constexpr std::size_t kFewestDigits = 6;
  const std::string stem = file.stem().string();
  return file.extension() == ".h5" && stem.size() >= kFewestDigits &&
         stem.find_first_not_of("0123456789") == std::string::npos;
}

bool IsCutSegment(const fs::path& file) {
  return file.extension() == ".part" && IsSegment(file.stem());
}

std::vector<fs::path> ListSegments(const fs::path& recording) {
  std::vector<fs::path> segments;
  std::error_code error;
  const fs::path folder = SegmentFolder(recording);
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (IsSegment(it->path())) segments.push_back(it->path());
  }
  std::sort(segments.begin(), segments.end());
  return segments;
}

JoinedSegments JoinSegments(const fs::path& recording, bool trust_all) {
  Joiner joiner(trust_all);
  JoinedSegments joined;
  std::error_code none;
  RemoveParts(SegmentFolder(recording));
  for (const fs::path& segment : ListSegments(recording)) {
    try {
      if (joiner.Add(segment) == 0) fs::remove(segment, none);
    } catch (const UserError& error) {
      joined.notes.push_back(std::string(error.what()) + ": this segment is left out");
    }
  }
  if (!joiner.cameras().empty()) WriteJoined(LinkedFile(recording), joiner.cameras());
  for (const JoinedCamera& camera : joiner.cameras()) {
    joined.names.push_back(camera.shape.name);
    joined.frames.push_back(camera.frames());
  }
  return joined;
}

}  // namespace stereomotion
