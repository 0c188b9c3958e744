#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>

#include "csv_table.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/run_reader.h"
#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

// Reads line by line: a long run has millions of rows, too many to hold as texts.
class DetectionsFile {
 public:
  DetectionsFile(fs::path file, const std::string& left, const std::string& right)
      : file_(std::move(file)), cameras_{left, right}, stream_(file_) {
    if (!stream_) {
      throw UserError(file_.string() + ": cannot be read, expected the detections of a run");
    }
    NextLine();
    const auto find = [&](const std::string& name) {
      const auto found = std::find(cells_.begin(), cells_.end(), name);
      if (found == cells_.end()) Fail("found no column '" + name + "', expected it in the header");
      return static_cast<std::size_t>(found - cells_.begin());
    };
    columns_ = cells_.size();
    for (std::size_t i = 0; i < kNames.size(); ++i) place_[i] = find(kNames[i]);
  }

  std::vector<RunDetections> ReadAll() {
    std::vector<RunDetections> frames;
    while (NextLine()) {
      if (cells_.size() != columns_) {
        Fail("found " + std::to_string(cells_.size()) + " cells, expected " +
             std::to_string(columns_));
      }
      const std::int64_t frame = Frame();
      if (!frames.empty() && frame < frames.back().frame) {
        Fail("frame: found " + std::to_string(frame) + " after " +
             std::to_string(frames.back().frame) + ", expected frames in ascending order");
      }
      if (frames.empty() || frame > frames.back().frame) {
        frames.emplace_back().frame = frame;
      }
      frames.back().balls[Camera()].push_back(Ball());
    }
    return frames;
  }

 private:
  enum Column { kFrame, kCamera, kStatus, kUu, kUv, kVv, kU, kV, kDiameter, kChi2, kVisible };
  static constexpr std::array<const char*, 11> kNames = {
      "frame",        "camera",       "status",      "cov_uu",   "cov_uv",          "cov_vv",
      "outline_u_px", "outline_v_px", "diameter_px", "chi2_dof", "visible_fraction"};

  bool NextLine() {
    std::string text;
    while (std::getline(stream_, text)) {
      ++line_;
      cells_ = SplitCells(text);
      if (cells_.size() > 1 || !cells_.front().empty()) return true;
    }
    if (line_ == 0) Fail("found an empty file, expected the detections of a run");
    return false;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw UserError(file_.string() + ":" + std::to_string(std::max(line_, 1)) + ": " + what);
  }

  [[nodiscard]] const std::string& Cell(Column column) const { return cells_[place_[column]]; }

  [[nodiscard]] std::int64_t Frame() const {
    const std::string& text = Cell(kFrame);
    std::int64_t frame = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
    if (error != std::errc() || end != text.data() + text.size()) {
      Fail("frame: found '" + text + "', expected a whole number");
    }
    return frame;
  }

  [[nodiscard]] std::size_t Camera() const {
    const std::string& name = Cell(kCamera);
    if (name == cameras_[0]) return 0;
    if (name != cameras_[1]) {
      Fail("camera: found '" + name + "', expected " + cameras_[0] + " or " + cameras_[1]);
    }
    return 1;
  }

  [[nodiscard]] BlobStatus Status() const {
    for (const BlobStatus status : {BlobStatus::kOk, BlobStatus::kPartly, BlobStatus::kClipped,
                                    BlobStatus::kSaturated, BlobStatus::kPoorFit}) {
      if (Cell(kStatus) == StatusWord(status)) return status;
    }
    Fail("status: found '" + Cell(kStatus) + "', expected a status word of docs/formats.md");
  }

  [[nodiscard]] double Number(Column column) const {
    const auto number = ParseNumber(Cell(column));
    if (!number) {
      Fail(std::string(kNames[column]) + ": found '" + Cell(column) + "', expected a number");
    }
    return *number;
  }

  [[nodiscard]] BallObservation Ball() const {
    BallObservation ball;
    ball.status = Status();
    ball.center_px = {Number(kU), Number(kV)};
    ball.semi_major_px = ball.semi_minor_px = ParseNumber(Cell(kDiameter)).value_or(0) / 2;
    ball.chi2_dof = ParseNumber(Cell(kChi2)).value_or(0);
    ball.visible_fraction = ParseNumber(Cell(kVisible)).value_or(1);
    if (ball.status != BlobStatus::kOk) return ball;
    ball.covariance_px2 << Number(kUu), Number(kUv), Number(kUv), Number(kVv);
    const bool definite = ball.covariance_px2(0, 0) > 0 && ball.covariance_px2.determinant() > 0;
    if (!definite) Fail("cov_uu, cov_uv, cov_vv: found no positive definite covariance");
    return ball;
  }

  fs::path file_;
  std::array<std::string, 2> cameras_;
  std::ifstream stream_;
  int line_ = 0;
  std::vector<std::string> cells_;
  std::size_t columns_ = 0;
  std::array<std::size_t, kNames.size()> place_{};
};

}  // namespace

std::vector<RunDetections> ReadDetections(const fs::path& run, const std::string& left_camera,
                                          const std::string& right_camera) {
  return DetectionsFile(run / "detections.csv", left_camera, right_camera).ReadAll();
}

}  // namespace stereomotion
