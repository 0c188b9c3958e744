#include "calibrate_inputs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "progress.h"
#include "stereomotion/calibration/observe_target.h"
#include "stereomotion/capture/read_image.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/detection/estimate_noise.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kImagesForNoise = 6;

/// One image to be looked at, with all that its thread needs.
struct Job {
  Job(fs::path file, const Target& what, ObservedImage of)
      : image(std::move(file)), target(&what), which(std::move(of)) {}

  fs::path image;
  const Target* target;
  ObservedImage which;
  int width_px = 0, height_px = 0;  // as found
  TargetSight sight;
};

Image ReadImage(const fs::path& file) {
  std::vector<std::uint8_t> bytes;
  Image image;
  std::string problem = ReadBytes(file, bytes);
  if (problem.empty()) problem = DecodeImage(bytes, image);
  if (!problem.empty()) throw UserError(file.string() + ": " + problem);
  return image;
}

SensorNoise LearnNoise(const std::vector<fs::path>& files, const std::string& camera,
                       std::vector<CalibrationNote>& notes) {
  std::vector<Image> images;
  for (std::size_t i = 0; i < std::min(files.size(), kImagesForNoise); ++i) {
    images.push_back(ReadImage(files[i]));
  }
  std::vector<ImageView> views;
  for (const Image& image : images) views.push_back(image.View());
  if (const auto noise = EstimateNoise(views)) return *noise;
  notes.push_back({"noise_unknown",
                   fmt::format("camera {}: its images show too little to learn the sensor's noise; "
                               "a usual one is assumed",
                               camera)});
  SensorNoise usual;
  if (!views.empty() && views[0].type == PixelType::kGray16) usual.saturation_dn = 65535;
  return usual;
}

std::vector<Job> ListJobs(const FrameFile& file, std::vector<CalibrationNote>& notes) {
  std::vector<Job> jobs;
  for (int c = 0; c < static_cast<int>(file.cameras.size()); ++c) {
    const FrameCamera& camera = file.cameras[c];
    SensorNoise noise;
    if (HasBalls(file.setup.target.type) && !camera.images.empty()) {
      noise = LearnNoise(camera.images, file.setup.cameras[c].name, notes);
    }
    for (int view = 0; view < static_cast<int>(camera.images.size()); ++view) {
      jobs.emplace_back(camera.images[view], file.setup.target,
                        ObservedImage{c, view, noise, camera.seeds});
    }
    for (int i = 0; i < static_cast<int>(camera.world_images.size()); ++i) {
      jobs.emplace_back(camera.world_images[i], *file.world_target,
                        ObservedImage{c, file.num_views + i, noise, camera.world_seeds});
    }
  }
  return jobs;
}

void RunJob(Job& job) {
  const Image image = ReadImage(job.image);
  const ImageView view = image.View();
  job.width_px = view.width_px;
  job.height_px = view.height_px;
  job.sight = ObserveTarget(view, *job.target, job.which);
}

void RunJobs(std::vector<Job>& jobs, int threads, const CommonOptions& common,
             const std::atomic<bool>& stop) {
  // One thread an image; OpenCV's own threads would only change the order of sums.
  cv::setNumThreads(1);
  Progress progress(static_cast<std::int64_t>(jobs.size()), common.quiet, "images");
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size() && !stop; i = next++) {
      try {
        RunJob(jobs[i]);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = jobs.size();
      }
      const std::lock_guard<std::mutex> lock(mutex);
      progress.Step();
    }
  };
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<std::thread> workers;
  for (int i = 1; i < (threads > 0 ? threads : cores); ++i) workers.emplace_back(work);
  work();
  for (auto& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);
}

void CheckSizes(const std::vector<Job>& jobs, FrameFile& file) {
  for (const Job& job : jobs) {
    CalibrationCamera& camera = file.setup.cameras[job.which.camera];
    if (camera.width_px == 0) {
      camera.width_px = job.width_px;
      camera.height_px = job.height_px;
    }
    if (camera.width_px == job.width_px && camera.height_px == job.height_px) continue;
    throw UserError(fmt::format(
        "{}: found an image of {} x {} pixels, expected {} x {} as camera {}'s other images "
        "(mixed_image_sizes)",
        job.image.string(), job.width_px, job.height_px, camera.width_px, camera.height_px,
        camera.name));
  }
}

// Seeds that fit the other camera's image better than their own camera's.
void CheckExchange(const std::vector<Job>& jobs, const FrameFile& file) {
  for (const Job& job : jobs) {
    if (!job.sight.problem || job.which.seeds.empty()) continue;
    for (int other = 0; other < static_cast<int>(file.cameras.size()); ++other) {
      if (other == job.which.camera || file.cameras[other].seeds.empty()) continue;
      ObservedImage exchanged = job.which;
      exchanged.seeds = file.cameras[other].seeds;
      const Image image = ReadImage(job.image);
      if (ObserveTarget(image.View(), *job.target, exchanged).problem) continue;
      throw UserError(fmt::format(
          "{}: the seeds of camera {} fit the image of camera {} and its own do not: are the "
          "cameras' images or seeds exchanged? (swapped_cameras)",
          job.image.string(), file.setup.cameras[other].name,
          file.setup.cameras[job.which.camera].name));
    }
  }
}

// The folder of one camera named like another camera: seen often, and otherwise hard to find.
void CheckFolderNames(const FrameFile& file, std::vector<CalibrationNote>& notes) {
  for (std::size_t c = 0; c < file.cameras.size(); ++c) {
    if (file.cameras[c].images.empty()) continue;
    const std::string folder = file.cameras[c].images[0].parent_path().filename().string();
    for (std::size_t other = 0; other < file.cameras.size(); ++other) {
      if (other == c || file.setup.cameras[other].name != folder) continue;
      notes.push_back({"swapped_cameras",
                       fmt::format("camera {} reads its images from a folder named {}: are the "
                                   "cameras exchanged?",
                                   file.setup.cameras[c].name, folder)});
    }
  }
}

CalibrationNote AboutImage(const fs::path& image, const CalibrationNote& note) {
  return {note.name, fmt::format("{}: {}", image.string(), note.text)};
}

// The last number in a file's name; nothing without one.
std::optional<long> NumberInName(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto end = stem.find_last_of("0123456789");
  if (end == std::string::npos) return std::nullopt;
  const auto before = stem.find_last_not_of("0123456789", end);
  const auto begin = before == std::string::npos ? 0 : before + 1;
  if (end - begin > 15) return std::nullopt;  // a time or a serial, not a count
  return std::stol(stem.substr(begin, end - begin + 1));
}

// Views are paired by their order. Numbers in the names that disagree, other than by a constant,
// mean that an image is missing somewhere.
void CheckFileNumbers(const FrameFile& file, std::vector<CalibrationNote>& notes) {
  if (file.setup.target.type == TargetType::kControlPoints) return;  // a frame at rest
  const auto& first = file.cameras[0].images;
  for (std::size_t c = 1; c < file.cameras.size(); ++c) {
    const auto& other = file.cameras[c].images;
    std::optional<long> shift;
    for (std::size_t view = 0; view < std::min(first.size(), other.size()); ++view) {
      const auto a = NumberInName(first[view]), b = NumberInName(other[view]);
      if (!a || !b) break;
      if (!shift) shift = *b - *a;
      if (*b - *a == *shift) continue;
      notes.push_back(
          {"wrong_pairs",
           fmt::format("view {}: {} and {} are taken as one pair, but their numbers "
                       "disagree: is an image of one camera missing?",
                       view, first[view].filename().string(), other[view].filename().string())});
      break;
    }
  }
}

void Collect(const std::vector<Job>& jobs, CalibrateInputs& inputs) {
  const int own_points = static_cast<int>(inputs.file.setup.target.points.size());
  for (const Job& job : jobs) {
    const bool of_world = job.target != &inputs.file.setup.target;
    for (TargetObservation o : job.sight.observations) {
      if (of_world) o.point += own_points;
      inputs.observations.push_back(o);
    }
    if (job.sight.problem) inputs.notes.push_back(AboutImage(job.image, *job.sight.problem));
    for (const auto& note : job.sight.notes) inputs.notes.push_back(AboutImage(job.image, note));
  }
}

// Why a camera saw nothing in any of its images.
std::optional<CalibrationNote> FindBlindCamera(const std::vector<Job>& jobs,
                                               const FrameFile& file) {
  for (int c = 0; c < static_cast<int>(file.cameras.size()); ++c) {
    std::optional<CalibrationNote> first;
    bool sees = !file.cameras[c].observations.empty();
    for (const Job& job : jobs) {
      if (job.which.camera != c) continue;
      if (!job.sight.problem) sees = true;
      if (job.sight.problem && !first) first = AboutImage(job.image, *job.sight.problem);
    }
    if (!sees && first) return first;
  }
  return std::nullopt;
}

void AddMeasured(CalibrateInputs& inputs) {
  for (int c = 0; c < static_cast<int>(inputs.file.cameras.size()); ++c) {
    for (const MeasuredPoint& measured : inputs.file.cameras[c].observations) {
      TargetObservation o{c, measured.view, measured.point, measured.pixel_px};
      const double sigma_px = measured.sigma_px.value_or(1);
      o.covariance_px2 = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
      if (!measured.sigma_px) inputs.image_sigma_known = false;
      inputs.observations.push_back(o);
    }
  }
}

}  // namespace

CalibrateInputs LoadCalibrateInputs(const fs::path& frame, int threads,
                                    const CommonOptions& common) {
  CalibrateInputs inputs;
  inputs.file = ReadFrame(frame);
  FrameFile& file = inputs.file;
  if (file.world_target) {
    file.setup.world_points = file.world_target->points;
    file.setup.world_ball_diameter_mm = file.world_target->ball_diameter_mm;
  }
  inputs.image_sigma_known = HasBalls(file.setup.target.type);
  std::vector<Job> jobs = ListJobs(file, inputs.notes);
  spdlog::info("looking for the target in {} images", jobs.size());
  const std::atomic<bool>& stop = CatchStopSignals();
  RunJobs(jobs, threads, common, stop);
  inputs.interrupted = stop;
  if (inputs.interrupted) return inputs;
  CheckSizes(jobs, file);
  CheckExchange(jobs, file);
  CheckFolderNames(file, inputs.notes);
  CheckFileNumbers(file, inputs.notes);
  Collect(jobs, inputs);
  AddMeasured(inputs);
  inputs.blind_camera = FindBlindCamera(jobs, file);
  return inputs;
}

}  // namespace stereomotion::app
