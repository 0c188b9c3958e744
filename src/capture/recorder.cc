#include "stereomotion/capture/recorder.h"

#include "folder_store.h"
#include "hdf5/hdf5_store.h"
#include "ring_recorder.h"

namespace stereomotion {

std::unique_ptr<Recorder> StartRecorder(const RecorderOptions& options) {
  const auto extension = options.output.extension();
  const bool is_file = extension == ".h5" || extension == ".hdf5";
  return MakeRingRecorder(is_file ? MakeHdf5Store(options) : MakeFolderStore(options),
                          options.ring_bytes);
}

}  // namespace stereomotion
