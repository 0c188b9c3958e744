#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "stereomotion/capture/camera_device.h"
#include "stereomotion/capture/live_report.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion {

struct LiveOptions {
  std::optional<double> pair_tolerance_ms;  ///< nothing: a quarter of the period
  double queue_s = 1;  ///< so much waits for measuring; then the oldest is dropped …
  std::int64_t queue_bytes = 1 << 29;  ///< … or when it is so much memory
  double reconnect_s = 30;             ///< so long a lost camera is waited for; 0: not at all
  double first_image_s = 10;           ///< so long the first image may take
  double trigger_hz = 0;    ///< above 0: both cameras are sent a software trigger so often
  std::int64_t count = -1;  ///< pairs; −1: without end
  double duration_s = 0;    ///< 0: without end
};

/// Takes every frame of both cameras in the order in which they are paired, whether it is measured
/// or dropped: a pair, a left frame alone or a right frame alone (the other is null). Frames are
/// shared and never change. Called from one thread; must not wait.
class FrameTap {
 public:
  virtual ~FrameTap() = default;
  virtual void Take(const std::shared_ptr<const Frame>& left,
                    const std::shared_ptr<const Frame>& right) = 0;
};

/// Delivers the pairs of two live cameras as they come.
///
/// A thread a camera receives; one pairs them by device time (`ClockFit` in the sources: offset and
/// drift between the clocks, from the least delayed arrivals). `Frame::timestamp_ns` is the left
/// camera's clock for both, going on across a reconnection; `Frame::index` the camera's own
/// unwrapped number counted from its first frame on, likewise. A pair that waits too long for being
/// measured is dropped, the oldest first: it is delivered without images, as `Frame::dropped`.
/// Memory does not grow while pairs are read; while nothing reads, a dropped pair leaves about 120
/// bytes (its times), 90 MB an hour at 200 Hz.
class LivePairs : public PairSource {
 public:
  /// Takes over two opened cameras; `tap` may be null and must outlive the object.
  LivePairs(std::unique_ptr<CameraDevice> left, std::unique_ptr<CameraDevice> right,
            LiveOptions options, FrameTap* tap = nullptr);
  ~LivePairs() override;
  LivePairs(const LivePairs&) = delete;
  LivePairs& operator=(const LivePairs&) = delete;

  /// Prepares both cameras, then starts both. Throws `DeviceError`.
  void Start();
  /// Ends the stream: no further frame is taken, the pairs that wait can still be read; then `Read`
  /// is false. `why` stands in the report. Safe from any thread.
  void Stop(const std::string& why);

  [[nodiscard]] std::int64_t size() const override { return kEndlessSource; }
  bool Read(std::int64_t position, FramePair& pair) const override;

  /// What happened so far; safe at any time, from any thread.
  [[nodiscard]] LiveReport report() const;
  /// Host time (CLOCK_MONOTONIC) [ns] of the middle of the exposure of a left frame with that time:
  /// its clock against the least delayed arrivals, less half the exposure; so it is later than the
  /// truth by the shortest delay (readout and transfer of the first byte).
  [[nodiscard]] std::int64_t HostTimeOf(std::int64_t timestamp_ns, double exposure_us) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stereomotion
