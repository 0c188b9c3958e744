#include "blob_measurer.h"

namespace stereomotion {

// Written in this session; until then it measures as `ml` does.
std::unique_ptr<BlobMeasurer> MakeCentroidMeasurer() { return MakeMlMeasurer(); }

}  // namespace stereomotion
