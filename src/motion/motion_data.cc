#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

PoseSeries PosesOf(const MotionData& data) {
  PoseSeries series;
  series.reserve(data.frames.size());
  for (const MotionFrame& frame : data.frames) series.push_back(frame.pose);
  return series;
}

}  // namespace stereomotion
