#include "image_stream.h"

#include <sys/resource.h>

#include <algorithm>
#include <string>

#include "receive_buffer.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

constexpr double kPool_s = 0.5;  ///< longer than a buffer waits for packets that never come (0.1 s)
constexpr std::size_t kFewestBuffers = 8;
constexpr std::size_t kMostPool_bytes = std::size_t{256} << 20;
constexpr double kUnknownRate_hz = 100;

std::size_t PoolSize(double rate_hz, std::size_t payload_bytes) {
  const double rate = rate_hz > 0 ? rate_hz : kUnknownRate_hz;
  const std::size_t most = std::max<std::size_t>(kMostPool_bytes / payload_bytes, 1);
  const auto wanted = static_cast<std::size_t>(kPool_s * rate);
  return std::max(kFewestBuffers, std::min(wanted, most));
}

// Called by the thread that reads packets: what it does not read in time is lost, so it goes before
// all others where this program may ask for that (else nothing happens).
void OnStream(void* /*unused*/, ArvStreamCallbackType type, ArvBuffer* /*buffer*/) {
  constexpr int kNice = -10;
  if (type == ARV_STREAM_CALLBACK_TYPE_INIT) setpriority(PRIO_PROCESS, 0, kNice);
}

// Where the stream's packets arrive. Other streams may have the same port at other addresses.
sockaddr_in SocketOf(ArvCamera* camera, ArvStream* stream) {
  sockaddr_in address{};
  ArvGvDevice* device = ARV_GV_DEVICE(arv_camera_get_device(camera));
  GSocketAddress* interface = arv_gv_device_get_interface_address(device);
  g_socket_address_to_native(interface, &address, sizeof address, nullptr);
  address.sin_port = htons(arv_gv_stream_get_port(ARV_GV_STREAM(stream)));
  return address;
}

bool HasAgreedFormat(ArvBuffer* buffer, const AgreedFormat& agreed) {
  const ArvBufferPayloadType type = arv_buffer_get_payload_type(buffer);
  if (type != ARV_BUFFER_PAYLOAD_TYPE_IMAGE &&
      type != ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA) {
    return false;
  }
  return arv_buffer_get_image_width(buffer) == agreed.width_px &&
         arv_buffer_get_image_height(buffer) == agreed.height_px &&
         arv_buffer_get_image_pixel_format(buffer) == agreed.pfnc;
}

ImageLayout LayoutOf(ArvBuffer* buffer, const AgreedFormat& agreed, std::size_t bytes) {
  gint x_padding = 0;
  gint y_padding = 0;
  arv_buffer_get_image_padding(buffer, &x_padding, &y_padding);
  ImageLayout layout{agreed.width_px, agreed.height_px, 0, bytes};
  if (x_padding > 0) {
    layout.stride_bytes =
        static_cast<std::ptrdiff_t>(BytesOfImage(agreed.format, agreed.width_px, 1)) + x_padding;
  }
  return layout;
}

}  // namespace

ImageStream::ImageStream(ArvCamera* camera, const std::string& uri, const AgreedFormat& agreed,
                         double rate_hz)
    : agreed_(agreed), arrivals_(Moment::Now()) {
  GErrorSlot error;
  const guint payload = arv_camera_get_payload(camera, error.out());
  if (error || payload == 0) {
    throw DeviceError(uri + ": the camera does not say how large its images are: " + error.text());
  }
  const bool gige = arv_camera_is_gv_device(camera) != 0;
  if (gige) {
    arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    arv_camera_gv_set_packet_size_adjustment(camera, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  }
  stream_.reset(arv_camera_create_stream(camera, OnStream, nullptr, error.out()));
  if (stream_ == nullptr) {
    throw DeviceError(uri + ": no image stream can be opened: " + error.text());
  }
  if (gige) {
    warning_ = ReceiveBufferWarning(uri, EnlargeReceiveBuffer(SocketOf(camera, stream_.get())));
  }
  for (std::size_t i = PoolSize(rate_hz, payload); i > 0; --i) {
    arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
  }
}

BufferState ImageStream::Next(std::chrono::microseconds at_most, RawFrame& frame, Image& image) {
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(
      stream_.get(), static_cast<guint64>(std::max<std::int64_t>(0, at_most.count())));
  if (buffer == nullptr) return BufferState::kNone;
  const BufferState state = Take(buffer, frame, image);
  arv_stream_push_buffer(stream_.get(), buffer);
  return state;
}

BufferState ImageStream::Take(ArvBuffer* buffer, RawFrame& frame, Image& image) {
  if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) return BufferState::kIncomplete;
  if (!HasAgreedFormat(buffer, agreed_)) return BufferState::kWrongFormat;
  std::size_t bytes = 0;
  const auto* data = static_cast<const std::uint8_t*>(arv_buffer_get_image_data(buffer, &bytes));
  const ImageLayout layout = LayoutOf(buffer, agreed_, bytes);
  if (!ConvertToGrey(data, agreed_.format, layout, image).empty()) return BufferState::kIncomplete;
  frame.number = arv_buffer_get_frame_id(buffer);
  frame.device_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer));
  const auto wall_ns = static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer));
  frame.host_ns = arrivals_.MonotonicNs(wall_ns, Moment::Now());
  return BufferState::kWhole;
}

StreamCounts ImageStream::counts() const {
  StreamCounts counts;
  guint64 whole = 0;
  guint64 failed = 0;
  guint64 missing = 0;
  arv_stream_get_statistics(stream_.get(), &whole, &failed, &counts.underruns);
  if (ARV_IS_GV_STREAM(stream_.get())) {
    arv_gv_stream_get_statistics(ARV_GV_STREAM(stream_.get()), &counts.resent_packets, &missing);
  }
  return counts;
}

}  // namespace stereomotion
