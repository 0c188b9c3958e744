#include <algorithm>
#include <array>

#include "h5_reader.h"
#include "recording_lock.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRank = 3;
using Corner = std::array<hsize_t, kRank>;

/// The block of frames that a data space selects.
struct Block {
  Corner first{}, last{};
  [[nodiscard]] hsize_t frames() const { return last[0] - first[0] + 1; }
};

// False: no one block of whole frames.
bool SelectedBlock(const H5Handle& space, Block& block) {
  if (H5Sget_simple_extent_ndims(space.id()) != static_cast<int>(kRank)) return false;
  Corner size{};
  H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  if (H5Sget_select_bounds(space.id(), block.first.data(), block.last.data()) < 0) return false;
  for (std::size_t i = 1; i < kRank; ++i) {
    if (block.first[i] != 0 || block.last[i] + 1 != size[i]) return false;
  }
  const hsize_t pixels = block.frames() * size[1] * size[2];
  return static_cast<hsize_t>(H5Sget_select_npoints(space.id())) == pixels;
}

// Reads a name whose length has to be asked for first. `%%` stands for `%` in a file's name.
template <class Get>
std::string NameOf(const Get& get) {
  const ssize_t size = get(nullptr, 0);
  if (size <= 0) return "";
  std::string name(static_cast<std::size_t>(size) + 1, '\0');
  get(name.data(), name.size());
  name.resize(static_cast<std::size_t>(size));
  for (std::size_t at = 0; (at = name.find("%%", at)) != std::string::npos; ++at) name.erase(at, 1);
  return name;
}

// `file`: that of the virtual dataset; a dot stands for it.
H5Run ReadRun(const H5Handle& list, std::size_t i, const fs::path& file) {
  H5Run run;
  const std::string source = NameOf([&](char* name, std::size_t size) {
    return H5Pget_virtual_filename(list.id(), i, name, size);
  });
  run.dataset = NameOf([&](char* name, std::size_t size) {
    return H5Pget_virtual_dsetname(list.id(), i, name, size);
  });
  // An absolute name stays as it is.
  run.file = source == "." ? file : file.parent_path() / source;
  Block here, there;
  if (!SelectedBlock(H5Handle(H5Pget_virtual_vspace(list.id(), i)), here) ||
      !SelectedBlock(H5Handle(H5Pget_virtual_srcspace(list.id(), i)), there) ||
      here.frames() != there.frames()) {
    return run;
  }
  run.first = static_cast<std::int64_t>(here.first[0]);
  run.in_file = static_cast<std::int64_t>(there.first[0]);
  run.count = static_cast<std::int64_t>(here.frames());
  return run;
}

}  // namespace

std::vector<H5Run> H5Reader::Runs(const std::string& name) const {
  const H5Handle dataset = OpenDataset(name);
  const H5Handle list(H5Dget_create_plist(dataset.id()));
  std::size_t count = 0;
  if (H5Pget_layout(list.id()) != H5D_VIRTUAL || H5Pget_virtual_count(list.id(), &count) < 0) {
    return {};
  }
  const fs::path file = LinkedFile(file_);
  std::vector<H5Run> runs;
  for (std::size_t i = 0; i < count; ++i) runs.push_back(ReadRun(list, i, file));
  return runs;
}

}  // namespace stereomotion
