#include <cerrno>

#include "src/capture/v4l2/controls.h"
#include "tests/capture/v4l2_camera_fixture.h"

namespace stereomotion::testing {
namespace {

CameraSettings WithControl(const std::string& name, const std::string& value) {
  CameraSettings settings;
  settings.controls[name] = value;
  return settings;
}

CameraSettings WithExposure(double exposure_us) {
  CameraSettings settings;
  settings.exposure_us = exposure_us;
  return settings;
}

CameraSettings WithGain(double gain) {
  CameraSettings settings;
  settings.gain_db = gain;
  return settings;
}

// A webcam's usual controls.
class V4l2ControlsTest : public V4l2Test {
 protected:
  V4l2ControlsTest() {
    AddControl(V4L2_CID_POWER_LINE_FREQUENCY, {"Power Line Frequency",
                                               V4L2_CTRL_TYPE_MENU,
                                               0,
                                               3,
                                               2,
                                               0,
                                               {{0, "Disabled"}, {1, "50 Hz"}, {2, "60 Hz"}}});
    AddControl(V4L2_CID_EXPOSURE_AUTO, {"Auto Exposure",
                                        V4L2_CTRL_TYPE_MENU,
                                        0,
                                        3,
                                        V4L2_EXPOSURE_APERTURE_PRIORITY,
                                        0,
                                        {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}}});
    AddControl(V4L2_CID_EXPOSURE_ABSOLUTE,
               {"Exposure Time, Absolute", V4L2_CTRL_TYPE_INTEGER, 3, 2047, 250});
    AddControl(V4L2_CID_EXPOSURE_AUTO_PRIORITY,
               {"Exposure, Dynamic Framerate", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1});
    AddControl(V4L2_CID_AUTOGAIN, {"Gain, Automatic", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1});
    AddControl(V4L2_CID_GAIN, {"Gain", V4L2_CTRL_TYPE_INTEGER, 0, 100, 10});
  }
  FakeControl& control(std::uint32_t id) { return device().controls.at(id); }
};

TEST(V4l2ControlKey, IsWhatAPersonTypes) {
  EXPECT_EQ(v4l2::ControlKey("Power Line Frequency"), "power_line_frequency");
  EXPECT_EQ(v4l2::ControlKey("Exposure Time, Absolute"), "exposure_time_absolute");
  EXPECT_EQ(v4l2::ControlKey("50 Hz."), "50_hz");
}

TEST_F(V4l2ControlsTest, AreSetByNameAndMenusByText) {
  const auto& frequency = control(V4L2_CID_POWER_LINE_FREQUENCY);
  Open(WithControl("power_line_frequency", "50hz"));
  EXPECT_EQ(frequency.value, 1);
  Open(WithControl("Power Line Frequency", "60 Hz"));
  EXPECT_EQ(frequency.value, 2);
  Open(WithControl("power_line_frequency", "0"));
  EXPECT_EQ(frequency.value, 0);
  Open(WithControl("gain_automatic", "off"));
  EXPECT_EQ(control(V4L2_CID_AUTOGAIN).value, 0);
  Open(WithControl("gain", "99"));
  EXPECT_EQ(control(V4L2_CID_GAIN).value, 99);
}

TEST_F(V4l2ControlsTest, IntegerMenusAreSetByTheirNumbers) {
  AddControl(V4L2_CID_LINK_FREQ,
             {"Link Frequency", V4L2_CTRL_TYPE_INTEGER_MENU, 0, 1, 0, 0, {{0, "300"}, {1, "600"}}});
  Open(WithControl("link_frequency", "600"));
  EXPECT_EQ(control(V4L2_CID_LINK_FREQ).value, 1);
}

TEST_F(V4l2ControlsTest, UnknownNamesAndValuesListWhatThereIs) {
  EXPECT_TRUE(Says(ErrorOf(WithControl("brightnes", "1")),
                   {"has no control brightnes, expected one of: ", "gain, power_line_frequency",
                    "exposure_time_absolute"}));
  EXPECT_TRUE(Says(ErrorOf(WithControl("power_line_frequency", "55hz")),
                   {"cannot be '55hz', expected disabled, 50_hz, 60_hz"}));
  EXPECT_TRUE(Says(ErrorOf(WithControl("power_line_frequency", "3")), {"cannot be '3'"}));
  EXPECT_TRUE(Says(ErrorOf(WithControl("gain", "full")), {"expected 0 … 100"}));
  EXPECT_TRUE(Says(ErrorOf(WithControl("gain", "101")), {"cannot be 101, expected 0 … 100"}));
  device().controls.clear();
  EXPECT_TRUE(Says(ErrorOf(WithControl("gain", "1")), {"offers no controls"}));
}

TEST_F(V4l2ControlsTest, RefusedReadOnlyOrHeldControlsAreErrors) {
  kernel->failures[VIDIOC_S_EXT_CTRLS] = {EBUSY};
  EXPECT_TRUE(Says(ErrorOf(WithControl("gain", "1")),
                   {"control gain cannot be set to 1", "another program"}));
  control(V4L2_CID_GAIN).keeps = 7;
  EXPECT_TRUE(Says(ErrorOf(WithControl("gain", "1")), {"was asked for 1 and took 7"}));
  control(V4L2_CID_GAIN).flags = V4L2_CTRL_FLAG_READ_ONLY;
  EXPECT_TRUE(Says(ErrorOf(WithControl("gain", "1")), {"can only be read"}));
}

TEST_F(V4l2ControlsTest, ModesAreSetBeforeTheValuesThatTheyOpen) {
  // This camera drops the exposure time when it changes its mode.
  class Forgetful : public FakeKernel {
    int Control(int descriptor, std::uint64_t request, void* argument) override {
      const int result = FakeKernel::Control(descriptor, request, argument);
      auto* controls = static_cast<v4l2_ext_controls*>(argument);
      if (request == VIDIOC_S_EXT_CTRLS && controls->controls->id == V4L2_CID_EXPOSURE_AUTO) {
        devices.at("/dev/video0").controls.at(V4L2_CID_EXPOSURE_ABSOLUTE).value = 3;
      }
      return result;
    }
  };
  const FakeDevice before = device();
  kernel = std::make_shared<Forgetful>();
  kernel->devices["/dev/video0"] = before;
  CameraSettings settings = WithControl("a_exposure", "manual mode");
  control(V4L2_CID_EXPOSURE_ABSOLUTE).name = "A Exposure";
  control(V4L2_CID_EXPOSURE_AUTO).name = "B Mode";
  settings.controls = {{"a_exposure", "500"}, {"b_mode", "Manual Mode"}};
  Open(settings);
  EXPECT_EQ(control(V4L2_CID_EXPOSURE_ABSOLUTE).value, 500);
}

TEST_F(V4l2ControlsTest, ExposureSwitchesToManualAndIsReadBack) {
  auto camera = Run(WithExposure(4000));
  EXPECT_EQ(control(V4L2_CID_EXPOSURE_AUTO).value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(control(V4L2_CID_EXPOSURE_ABSOLUTE).value, 40);
  Arrive(0);
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  EXPECT_EQ(frame.exposure_us, 4000);
  EXPECT_TRUE(camera->warnings().empty());
}

TEST_F(V4l2ControlsTest, AnExposureThatIsTakenOtherwiseIsTold) {
  EXPECT_TRUE(Say(Open(WithExposure(1030))->warnings(), {"exposes for 1000 µs, not for 1030 µs"}));
  control(V4L2_CID_EXPOSURE_ABSOLUTE).keeps = 400;
  EXPECT_TRUE(
      Say(Open(WithExposure(1000))->warnings(),
          {"exposes for 40000 µs, not for 1000 µs", "the exposure is longer than the period"}));
  EXPECT_TRUE(Says(ErrorOf(WithExposure(200)), {"cannot expose for 200 µs, expected 300 µs"}));
  EXPECT_TRUE(Says(ErrorOf(WithExposure(1e9)), {"cannot expose for 1e+09 µs"}));
}

TEST_F(V4l2ControlsTest, ExposureInUnknownUnitsIsRefusedWithTheWayOut) {
  device().controls.erase(V4L2_CID_EXPOSURE_ABSOLUTE);
  EXPECT_TRUE(Says(ErrorOf(WithExposure(1000)), {"has no exposure in µs; leave it out"}));
  AddControl(V4L2_CID_EXPOSURE, {"Exposure", V4L2_CTRL_TYPE_INTEGER, 4, 1000, 800});
  EXPECT_TRUE(Says(ErrorOf(WithExposure(1000)), {"set the control exposure (4 … 1000)"}));
}

TEST_F(V4l2ControlsTest, AutomaticExposureIsUnknownAndTold) {
  const auto camera = Run();
  EXPECT_TRUE(Say(camera->warnings(), {"its exposure is automatic"}));
  Arrive(0);
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  EXPECT_EQ(frame.exposure_us, 0);
}

TEST_F(V4l2ControlsTest, GainSwitchesTheAutomaticOff) {
  Open(WithGain(42));
  EXPECT_EQ(control(V4L2_CID_GAIN).value, 42);
  EXPECT_EQ(control(V4L2_CID_AUTOGAIN).value, 0);
  EXPECT_TRUE(Says(ErrorOf(WithGain(4.5)), {"whole units of its driver"}));
  control(V4L2_CID_GAIN).keeps = 7;
  EXPECT_TRUE(Says(ErrorOf(WithGain(4)), {"asked for gain 4 and took 7"}));
  device().controls.erase(V4L2_CID_GAIN);
  EXPECT_TRUE(Says(ErrorOf(WithGain(4)), {"has no gain that can be set"}));
}

TEST_F(V4l2ControlsTest, AWishedRateKeepsTheCameraFromSlowingDown) {
  CameraSettings settings;
  settings.frame_rate_hz = 30;
  Open(settings);
  EXPECT_EQ(control(V4L2_CID_EXPOSURE_AUTO_PRIORITY).value, 0);
}

}  // namespace
}  // namespace stereomotion::testing
