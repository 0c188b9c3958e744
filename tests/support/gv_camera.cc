#include "tests/support/gv_camera.h"

#include <arv.h>

#include <atomic>
#include <cstring>
#include <stdexcept>

#include "tests/support/gv_images.h"

namespace stereomotion::testing {
namespace {

struct Target {
  std::uint8_t* bytes;
  int u_px, v_px, width_px, height_px;
  ArvPixelFormat format;
};

int BytesPerPixel(ArvPixelFormat format) {
  return static_cast<int>(ARV_PIXEL_FORMAT_BIT_PER_PIXEL(format)) / 8;
}

/// Writes one grey value as the format stores it; colours are all equal.
void PutPixel(std::uint8_t* out, ArvPixelFormat format, bool deep, int value) {
  if (format == ARV_PIXEL_FORMAT_MONO_16) {
    const auto wide = static_cast<std::uint16_t>(deep ? value : value << 8);
    std::memcpy(out, &wide, sizeof wide);
    return;
  }
  const int bytes = BytesPerPixel(format);
  for (int i = 0; i < bytes; ++i) out[i] = static_cast<std::uint8_t>(deep ? value >> 8 : value);
}

void CopyPart(const ImageView& image, const Target& target) {
  const bool deep = image.type == PixelType::kGray16;
  const int bytes = BytesPerPixel(target.format);
  const bool same = !deep && bytes == 1;
  for (int v = 0; v < target.height_px; ++v) {
    std::uint8_t* out = target.bytes + static_cast<std::ptrdiff_t>(v) * target.width_px * bytes;
    const int from = v + target.v_px;
    if (from >= image.height_px) break;
    if (same) {
      std::memcpy(out, image.Row<std::uint8_t>(from) + target.u_px,
                  static_cast<std::size_t>(target.width_px));
      continue;
    }
    for (int u = 0; u < target.width_px; ++u, out += bytes) {
      PutPixel(out, target.format, deep, static_cast<int>(image.At(u + target.u_px, from)));
    }
  }
}

ArvPixelFormat FormatOf(const std::string& name) {
  if (name == "Mono8") return ARV_PIXEL_FORMAT_MONO_8;
  if (name == "Mono16") return ARV_PIXEL_FORMAT_MONO_16;
  if (name == "RGB8") return ARV_PIXEL_FORMAT_RGB_8_PACKED;
  if (name == "BayerRG8") return ARV_PIXEL_FORMAT_BAYER_RG_8;
  throw std::invalid_argument("the fake camera has no pixel format " + name);
}

}  // namespace

struct GvCamera::Impl {
  explicit Impl(const GvPlan& wanted) : plan(wanted), images(LoadGvImages(wanted)) {}

  // Called by the camera's thread for each frame.
  static void FillBuffer(ArvBuffer* buffer, void* self, guint32 /*exposure_us*/, guint32 /*gain*/,
                         ArvPixelFormat format) {
    static_cast<Impl*>(self)->Fill(buffer, format);
  }

  // The grid on which the camera sends: what the client has set, and what Aravis makes of it.
  std::int64_t TrueTimeUs() {
    const std::int64_t now_us = g_get_real_time();
    if (arv_fake_camera_is_in_software_trigger_mode(fake) != 0) return now_us;
    guint32 period_us = 0;
    arv_fake_camera_read_register(fake, ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
                                  &period_us);
    if (period_us == 0) return now_us;
    const std::int64_t slot = now_us / period_us;
    count += count < 0 ? 1 : slot - last_slot;
    last_slot = slot;
    return slot * period_us;
  }

  void Fill(ArvBuffer* buffer, ArvPixelFormat format) {
    const std::int64_t before = count;
    const std::int64_t true_us = TrueTimeUs();
    if (count == before) ++count;  // triggered
    arv_buffer_set_frame_id(buffer, GvFrameId(plan, count));
    arv_buffer_set_timestamp(buffer, static_cast<guint64>(GvDeviceNs(plan, true_us, started_us)));
    Target target{};
    target.format = format;
    target.bytes = static_cast<std::uint8_t*>(const_cast<void*>(  // ours to fill, by its contract
        arv_buffer_get_data(buffer, nullptr)));
    arv_buffer_get_image_region(buffer, &target.u_px, &target.v_px, &target.width_px,
                                &target.height_px);
    const int place = GvImageAt(plan, true_us, static_cast<int>(images.size()));
    CopyPart(images[static_cast<std::size_t>(place)].View(), target);
    if (plan.stamp) std::memcpy(target.bytes, &true_us, sizeof true_us);
    AfterFrame(++sent);
  }

  void AfterFrame(std::int64_t so_many) const {
    if (so_many == plan.frames) {
      arv_fake_camera_write_register(fake, ARV_FAKE_CAMERA_REGISTER_ACQUISITION, 0);
    }
    if (so_many == plan.change_format_after) {
      arv_fake_camera_write_register(fake, ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT,
                                     ARV_PIXEL_FORMAT_BAYER_GR_8);
    }
  }

  void Write(guint32 address, double value) const {
    arv_fake_camera_write_register(fake, address, static_cast<guint32>(value));
  }

  void SetRegisters() const {
    const ImageView view = images.front().View();
    Write(ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, view.width_px);
    Write(ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, view.height_px);
    Write(ARV_FAKE_CAMERA_REGISTER_WIDTH, view.width_px);
    Write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, view.height_px);
    Write(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, FormatOf(plan.pixel_format));
    Write(ARV_FAKE_CAMERA_REGISTER_EXPOSURE_TIME_US, plan.exposure_us);
    Write(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
          static_cast<double>(GvPeriodUs(plan.rate_hz * plan.rate_factor)));
    // So often a software trigger is looked for.
    constexpr double kTriggerPolls_hz = 500;
    arv_fake_camera_set_trigger_frequency(fake, kTriggerPolls_hz);
    constexpr guint32 kPacketSizeRegister = 0x0d04;  // GigE Vision: SCPS of stream channel 0
    if (plan.packet_bytes > 0) Write(kPacketSizeRegister, plan.packet_bytes);
  }

  GvPlan plan;
  std::vector<Image> images;
  std::int64_t started_us = g_get_real_time();
  std::int64_t last_slot = 0;
  std::int64_t count = -1;  // frames since the first, those that were skipped included
  std::atomic<std::int64_t> sent{0};
  ArvGvFakeCamera* server = nullptr;
  ArvFakeCamera* fake = nullptr;
};

GvCamera::GvCamera(const GvPlan& plan) : impl_(std::make_unique<Impl>(plan)) {
  impl_->server = arv_gv_fake_camera_new(plan.address.c_str(), plan.serial.c_str());
  if (arv_gv_fake_camera_is_running(impl_->server) == 0) {
    g_object_unref(impl_->server);
    throw std::runtime_error("no camera can be served at " + plan.address);
  }
  g_object_set(impl_->server, "gvsp-lost-ratio", plan.lost_per_mille / 1000, nullptr);
  impl_->fake = arv_gv_fake_camera_get_fake_camera(impl_->server);
  impl_->SetRegisters();
  arv_fake_camera_set_fill_pattern(impl_->fake, Impl::FillBuffer, impl_.get());
}

GvCamera::~GvCamera() { g_object_unref(impl_->server); }

std::int64_t GvCamera::sent() const { return impl_->sent; }

}  // namespace stereomotion::testing
