#include "blob_measurer.h"

namespace stereomotion {

// Written in this session; until then it measures as `ml` does.
std::unique_ptr<BlobMeasurer> MakeWaveletMeasurer() { return MakeMlMeasurer(); }

}  // namespace stereomotion
