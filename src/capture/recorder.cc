#include "stereomotion/capture/recorder.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "folder_store.h"
#include "hdf5/hdf5_store.h"
#include "ring_recorder.h"

namespace stereomotion {

bool HasRecordingExtension(const std::filesystem::path& name) {
  std::string extension = name.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".h5" || extension == ".hdf5";
}

std::unique_ptr<Recorder> StartRecorder(const RecorderOptions& options) {
  const bool is_file = HasRecordingExtension(options.output);
  return MakeRingRecorder(is_file ? MakeHdf5Store(options) : MakeFolderStore(options),
                          options.ring_bytes);
}

}  // namespace stereomotion
