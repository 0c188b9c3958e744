// stereomotion_gv_server: GigE Vision cameras without hardware, for the tests of live capture.
//
// usage: stereomotion_gv_server [OPTIONS of all cameras] --camera cam0 [OPTIONS] [--camera cam1 …]
//
//   --recording REC       images of REC/<camera>/*.png, by name; without it a synthetic pattern
//   --camera NAME         starts a camera; its options follow. Name: folder in REC
//   --address IP          127.0.0.1; must be an address (or name) of an interface of this host
//   --serial TEXT         the camera's name; its id is then Aravis-Fake-TEXT
//   --rate HZ             25; frames are sent at multiples of the period 1e6/HZ µs (rounded to
//   whole
//                         µs) in UNIX time: cameras of one rate are in step, in other processes too
//   --rate-factor X       1; 1.003: sends 0.3 % faster (on its own grid), shows the same scene
//   --clock-offset-s S    0; added to the device clock
//   --clock-drift-ppm D   0; the device clock is fast by so much
//   --clock-from-start    the device clock counts from the program's start, as after a power cut
//   --lost-per-mille P    0; packets that are not sent
//   --first-id N          1; number of the first frame; 16 bit, 65535 is followed by 1
//   --ids-with-zero       65535 is followed by 0
//   --frames N            after so many frames the camera is silent (but answers)
//   --change-format-after N   after so many frames it says that its pixels are BayerGR8
//   --pixel-format F      Mono8, Mono16, RGB8, BayerRG8; Mono16 of 8-bit images: values × 256
//   --exposure-us T       1000; what the camera says of its exposure
//   --size WxH            640x480; of the synthetic pattern
//   --images N            120; so many images of the recording are loaded at most
//   --packet-bytes N      as the fake camera has it; a client may set it too
//   --stamp               puts the true UNIX time [µs, int64 little endian] into the first 8 bytes
//                         of each image: two images of a pair belong together iff it is the same
//   --stop-after S        ends so many seconds after READY (of the program)
//   --seed N              1; of the lost packets (of the program)
//
// Prints READY when all cameras answer, and "sent NAME N" for each at the end. SIGINT and SIGTERM
// end it cleanly (control is not released: as if the plug were pulled).
//
// Device time of a frame [ns], from the true time t [ns, UNIX] at which it was sent:
//   device = (t − 1700000000e9) · (1 + D·1e-6) + S·1e9        (gv_plan.h: GvDeviceNs)
// and t is a multiple of the period. The image shown at t is number k of the N loaded, to and fro:
//   j = floor(t/period + 1/2) mod (2N − 2);   k = j < N ? j : 2N − 2 − j     (GvImageAt)
// with the period of --rate, whatever --rate-factor: both cameras show the same scene at one time.
// Frames that the host's load made it skip are missing in the frame numbers as well.

#include <glib.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/gv_camera.h"
#include "tests/support/gv_plan.h"

namespace {

using stereomotion::testing::GvCamera;
using stereomotion::testing::GvPlan;
using stereomotion::testing::GvServerPlan;

volatile std::sig_atomic_t interrupted = 0;  // the one thing that a signal handler may touch

void Serve(const GvServerPlan& plan) {
  g_random_set_seed(plan.seed);
  std::vector<std::unique_ptr<GvCamera>> cameras;
  for (const GvPlan& camera : plan.cameras) cameras.push_back(std::make_unique<GvCamera>(camera));
  std::puts("READY");
  std::fflush(stdout);
  constexpr gulong kLook_us = 20'000;
  const gint64 start_us = g_get_monotonic_time();
  const auto over = [&] {
    const auto run_s = static_cast<double>(g_get_monotonic_time() - start_us) * 1e-6;
    return interrupted != 0 || (plan.stop_after_s > 0 && run_s >= plan.stop_after_s);
  };
  while (!over()) g_usleep(kLook_us);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::printf("sent %s %lld\n", plan.cameras[i].camera.c_str(),
                static_cast<long long>(cameras[i]->sent()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kNice =
      -10;  // a camera does not wait for other programs; nothing without the right
  setpriority(PRIO_PROCESS, 0, kNice);
  try {
    std::signal(SIGINT, [](int) { interrupted = 1; });
    std::signal(SIGTERM, [](int) { interrupted = 1; });
    Serve(stereomotion::testing::ParseGvServerArguments({argv + 1, argv + argc}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereomotion_gv_server: %s\n", error.what());
    return 2;
  }
  return 0;
}
