// How fast a recording is written and read back, beside a plain write() of the same bytes.
// usage: stereomotion_record_bench FOLDER [PAIRS]

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "stereomotion/capture/recorder.h"
#include "stereomotion/capture/recording.h"

namespace {

using namespace stereomotion;
namespace fs = std::filesystem;

constexpr int kWidth_px = 1280, kHeight_px = 1024;
constexpr std::int64_t kRingBytes = std::int64_t{256} << 20;
constexpr double kBytesPerMb = 1e6;

double SecondsOf(const std::function<void()>& act) {
  const auto start = std::chrono::steady_clock::now();
  act();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::shared_ptr<const Frame> MakeFrame(std::int64_t number, int side) {
  constexpr std::int64_t kPeriodNs = 16'666'667;
  auto frame = std::make_shared<Frame>();
  frame->index = number;
  frame->timestamp_ns = number * kPeriodNs;
  frame->image.Resize(kWidth_px, kHeight_px, PixelType::kGray8);
  for (int v = 0; v < kHeight_px; ++v) {
    for (int u = 0; u < kWidth_px; ++u) {
      frame->image.Row<std::uint8_t>(v)[u] = static_cast<std::uint8_t>(u * v + number + side);
    }
  }
  return frame;
}

// Hands out images as fast as they are taken, so that the disk alone is measured.
void Record(Recorder& recorder, std::int64_t pairs) {
  std::vector<std::shared_ptr<const Frame>> left, right;
  constexpr std::int64_t kDifferent = 8;
  for (std::int64_t i = 0; i < kDifferent; ++i) {
    left.push_back(MakeFrame(i, 0));
    right.push_back(MakeFrame(i, 1));
  }
  constexpr std::int64_t kPairBytes = std::int64_t{2} * kWidth_px * kHeight_px;
  for (std::int64_t i = 0; i < pairs; ++i) {
    // Numbers and times of the first ones come again: nobody looks at them here.
    recorder.Take(left[static_cast<std::size_t>(i % kDifferent)],
                  right[static_cast<std::size_t>(i % kDifferent)]);
    while ((i + 1) * kPairBytes - recorder.counts().bytes > kRingBytes / 2) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  recorder.Finish();
}

void WritePlain(const fs::path& file, std::int64_t pairs) {
  const auto frame = MakeFrame(0, 0);
  const ImageView image = frame->image.View();
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  for (std::int64_t i = 0; i < 2 * pairs; ++i) {
    const ssize_t bytes = write(fd, image.data, std::size_t{kWidth_px} * kHeight_px);
    if (bytes <= 0) std::exit(1);
  }
  fdatasync(fd);
  close(fd);
}

void ReadBack(const fs::path& file, std::int64_t pairs) {
  const auto recording = OpenRecording(file.string() + ":cam0", file.string() + ":cam1");
  FramePair pair;
  for (std::int64_t i = 0; i < pairs; ++i) recording->Read(i, pair);
}

void Print(const char* what, std::int64_t pairs, double seconds) {
  const double mb = 2.0 * kWidth_px * kHeight_px * static_cast<double>(pairs) / kBytesPerMb;
  fmt::print("{:<28} {:8.0f} MB/s {:8.0f} pairs/s\n", what, mb / seconds,
             static_cast<double>(pairs) / seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const fs::path folder = argc > 1 ? argv[1] : ".";
  const std::int64_t pairs = argc > 2 ? std::atoll(argv[2]) : 600;
  const fs::path plain = folder / "plain.bin", file = folder / "bench.h5";
  // Twice: blocks of a virtual disk that were never used before are slow.
  for (const char* what : {"write(), fdatasync, first", "write(), fdatasync"}) {
    Print(what, pairs, SecondsOf([&] { WritePlain(plain, pairs); }));
    fs::remove(plain);
  }
  RecorderOptions options{file};
  options.ring_bytes = kRingBytes;
  options.overwrite = true;
  const auto recorder = StartRecorder(options);
  Print("recorder, all on the disk", pairs, SecondsOf([&] { Record(*recorder, pairs); }));
  const RecorderCounts counts = recorder->counts();
  if (counts.dropped > 0 || !counts.problem.empty()) {
    fmt::print("{} dropped; {}\n", counts.dropped, counts.problem);
  }
  Print("read back (page cache)", counts.pairs, SecondsOf([&] { ReadBack(file, counts.pairs); }));
  fs::remove(file);
  fs::remove_all(file.string() + ".segments");
  return 0;
}
