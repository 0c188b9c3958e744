#include "src/capture/aravis/frame_delivery.h"

#include <gtest/gtest.h>

namespace stereomotion {
namespace {

RawFrame Raw(std::uint64_t number) {
  return {number, static_cast<std::int64_t>(number) * 1'000'000, 0};
}

TEST(FrameDelivery, GapsAreLostUnlessTheyAreExplained) {
  FrameDelivery delivery;
  DeviceFrame frame;
  EXPECT_TRUE(delivery.Deliver(Raw(10), frame));
  EXPECT_TRUE(delivery.Deliver(Raw(11), frame));
  delivery.Drop(&DeviceCounts::incomplete);       // 12
  EXPECT_TRUE(delivery.Deliver(Raw(14), frame));  // 13 never came
  EXPECT_EQ(delivery.counts().frames, 3);
  EXPECT_EQ(delivery.counts().incomplete, 1);
  EXPECT_EQ(delivery.counts().lost, 1);
  StreamCounts stream;
  stream.underruns = 200;  // packets
  delivery.CountStream(stream);
  EXPECT_TRUE(delivery.Deliver(Raw(17), frame));
  EXPECT_EQ(delivery.counts().underruns, 2);
  EXPECT_EQ(delivery.counts().lost, 1);
}

TEST(FrameDelivery, ARestartIsNoGap) {
  FrameDelivery delivery;
  DeviceFrame frame;
  delivery.Deliver(Raw(10), frame);
  StreamCounts stream;
  stream.resent_packets = 5;
  delivery.CountStream(stream);
  delivery.StreamEnds();
  delivery.Restart(0);
  EXPECT_TRUE(delivery.Deliver(Raw(1), frame)) << "an earlier time is no fault now";
  EXPECT_EQ(frame.frame_id, 1);
  stream.resent_packets = 2;
  delivery.CountStream(stream);
  EXPECT_EQ(delivery.counts().resent_packets, 7);
  EXPECT_EQ(delivery.counts().lost, 0);
}

}  // namespace
}  // namespace stereomotion
