#include "tests/capture/v4l2_camera_fixture.h"

namespace stereomotion::testing {
namespace {

TEST_F(V4l2StreamTest, TimesBecomeMidExposure) {
  struct Case {
    std::uint32_t flags;
    TimestampPoint wanted;
    std::int64_t to_middle_ns;
  };
  constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  for (const Case& c : {
           Case{kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE, TimestampPoint::kDefault,
                kHalfExposureNs},
           Case{kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_EOF, TimestampPoint::kDefault,
                -kHalfExposureNs},
           Case{kMonotonic, TimestampPoint::kExposureStart, kHalfExposureNs},
           Case{kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE, TimestampPoint::kMidExposure, 0},
       }) {
    device().timestamp_flags = c.flags;
    CameraSettings settings;
    settings.timestamp_at = c.wanted;
    const auto camera = Run(settings);
    EXPECT_EQ(camera->clock(), "monotonic");
    const std::int64_t stamp_ns = Arrive(0).timestamp_ns;
    kernel->now_ns += 3'000'000;
    ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
    EXPECT_EQ(frame.device_ns, stamp_ns + c.to_middle_ns);
    EXPECT_EQ(frame.host_ns, frame.device_ns + kHalfExposureNs);  // the exposure's end
  }
}

TEST_F(V4l2StreamTest, WithoutMonotonicStampsTheArrivalCounts) {
  for (const std::uint32_t flags :
       {V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, V4L2_BUF_FLAG_TIMESTAMP_COPY}) {
    device().timestamp_flags = flags;
    const auto camera = Run();
    EXPECT_EQ(camera->clock(), "");
    EXPECT_TRUE(Say(camera->warnings(), {"the time of arrival has to do"}));
    Arrive(0).timestamp_ns = 77;
    kernel->now_ns += 3'000'000;
    ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
    EXPECT_EQ(frame.device_ns, kernel->now_ns - kHalfExposureNs);
    EXPECT_EQ(frame.host_ns, kernel->now_ns);
  }
}

TEST_F(V4l2StreamTest, ImpossibleTimesAreNotUsed) {
  const auto camera = Run();
  Arrive(0).timestamp_ns += 1'000'000'000'000;  // another clock
  EXPECT_EQ(Next(camera), DeviceEvent::kIncomplete);
  Arrive(1);
  EXPECT_EQ(Next(camera), DeviceEvent::kFrame);
  Arrive(2).timestamp_ns -= 1'000'000;  // the same time again
  EXPECT_EQ(Next(camera), DeviceEvent::kIncomplete);
  EXPECT_EQ(camera->counts().incomplete, 2);
  EXPECT_TRUE(Say(camera->warnings(), {"not of the monotonic clock", "time does not advance"}));
}

TEST_F(V4l2StreamTest, GapsAreCountedAcrossTheWrap) {
  const auto camera = Run();
  for (const std::uint32_t sequence : {0xFFFFFFFDU, 0xFFFFFFFFU, 1U, 2U, 7U}) {
    Arrive(sequence);
    ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  }
  EXPECT_EQ(frame.frame_id, 0x100000007);
  EXPECT_EQ(camera->counts().lost, 1 + 1 + 4);
  EXPECT_EQ(camera->counts().frames, 5);
  EXPECT_TRUE(camera->warnings().empty());
}

TEST_F(V4l2StreamTest, ADriverThatDoesNotCountIsTold) {
  const auto camera = Run();
  for (int i = 0; i < 3; ++i) {
    Arrive(0);
    ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
    EXPECT_EQ(frame.frame_id, i);
  }
  EXPECT_EQ(camera->counts().lost, 0);
  EXPECT_TRUE(Say(camera->warnings(), {"does not number the images"}));
}

}  // namespace
}  // namespace stereomotion::testing
