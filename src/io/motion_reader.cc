#include "stereomotion/io/motion_reader.h"

#include <algorithm>
#include <map>

#include "csv_stream.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/run_reader.h"
#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

// Reads balls.csv into frames that are there already.
class BallsFile {
 public:
  BallsFile(const fs::path& file, const Body& body) : csv_(file, "the balls of a run") {
    frame_ = csv_.Require("frame");
    rod_ = csv_.Require("rod");
    ball_ = csv_.Require("ball");
    for (const std::string side : {"left", "right"}) {
      std::vector<int>& columns = center_[side == "left" ? 0 : 1];
      for (const std::string& name : {"u_" + side + "_px", "v_" + side + "_px", "cov_uu_" + side,
                                      "cov_uv_" + side, "cov_vv_" + side}) {
        columns.push_back(csv_.Require(name));
      }
    }
    int first = 0;
    for (const Rod& rod : body.rods) {
      const auto count = static_cast<int>(rod.balls_in_body_mm.size());
      rods_.emplace(rod.name, std::pair{first, count});
      first += count;
    }
  }

  // `wanted` says of every frame whether its points are kept.
  void ReadInto(const std::vector<bool>& wanted, std::vector<MotionFrame>& frames) {
    std::size_t at = 0;
    while (csv_.Next()) {
      const std::int64_t frame = csv_.Integer(frame_);
      while (at < frames.size() && frames[at].pose.frame < frame) ++at;
      if (at == frames.size() || frames[at].pose.frame != frame) {
        csv_.Fail(frame_, "frames of poses.csv in ascending order");
      }
      if (!wanted[at]) continue;
      const int ball = Ball();
      for (int camera = 0; camera < 2; ++camera) AddPoint(camera, ball, frames[at].image_points);
    }
  }

 private:
  [[nodiscard]] int Ball() const {
    const auto rod = rods_.find(std::string(csv_.Cell(rod_)));
    if (rod == rods_.end()) csv_.Fail(rod_, "a rod of the body");
    const std::int64_t ball = csv_.Integer(ball_);
    if (ball < 0 || ball >= rod->second.second) csv_.Fail(ball_, "a ball of its rod");
    return rod->second.first + static_cast<int>(ball);
  }

  void AddPoint(int camera, int ball, std::vector<ImagePoint>& points) const {
    const std::vector<int>& columns = center_[static_cast<std::size_t>(camera)];
    if (csv_.AllEmpty(columns)) return;
    ImagePoint& point = points.emplace_back();
    point.camera = camera;
    point.ball = ball;
    point.center_px = {csv_.Number(columns[0]), csv_.Number(columns[1])};
    const double uv = csv_.Number(columns[3]);
    point.covariance_px2 << csv_.Number(columns[2]), uv, uv, csv_.Number(columns[4]);
    const bool definite = point.covariance_px2(0, 0) > 0 && point.covariance_px2.determinant() > 0;
    if (!definite) csv_.Fail(columns[2], "a positive definite covariance");
  }

  CsvStream csv_;
  int frame_ = -1, rod_ = -1, ball_ = -1;
  std::array<std::vector<int>, 2> center_;
  std::map<std::string, std::pair<int, int>> rods_;  // first ball, number of balls
};

int CameraIndex(const Rig& rig, const std::string& name, int otherwise, const fs::path& file) {
  if (name.empty()) return otherwise;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (rig.cameras[i].name == name) return static_cast<int>(i);
  }
  throw UserError(file.string() + ": cameras: found no camera '" + name +
                  "', expected it as run.json names it");
}

// The poses of a single rod are those of its first ball, whatever its coordinates in the body.
void SetBalls(const Body& body, MotionData& data) {
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& ball : rod.balls_in_body_mm) data.balls_in_body_mm.push_back(ball);
  }
  if (body.rods.size() == 1) {
    const Eigen::Vector3d first_mm = data.balls_in_body_mm.front();
    for (Eigen::Vector3d& ball : data.balls_in_body_mm) ball -= first_mm;
  }
  if (LargestBallSigmaMm(body) > 0) data.structure_covariance_mm2 = CovarianceOfBalls(body);
}

// Which frames get their image points.
std::vector<bool> WantedFrames(const std::vector<MotionFrame>& frames, std::size_t most) {
  const auto measured = static_cast<std::size_t>(std::count_if(
      frames.begin(), frames.end(), [](const MotionFrame& frame) { return frame.pose.measured; }));
  const std::size_t stride = JointFitStride(measured, most);
  std::vector<bool> wanted(frames.size(), false);
  std::size_t count = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].pose.measured) continue;
    wanted[i] = measured <= kMostFramesWithPoints || count % stride == 0 || count < kOffsetFrames;
    ++count;
  }
  return wanted;
}

fs::path FirstThere(const std::vector<fs::path>& candidates) {
  std::error_code ignored;
  for (const fs::path& file : candidates) {
    if (fs::is_regular_file(file, ignored)) return file;
  }
  return {};
}

}  // namespace

MotionFiles MotionFiles::In(const fs::path& run) {
  MotionFiles files;
  files.poses = run / "poses.csv";
  files.balls = FirstThere({run / "balls.csv"});
  files.body = FirstThere({run / "body.yaml"});
  // RUN/<body>: what concerns all bodies stands one folder up. Not so beside a RUN of its own,
  // where another rig.yaml may lie.
  const fs::path record = FirstThere({run / "run.json", run / ".." / "run.json"});
  const fs::path root = record.empty() ? run : record.parent_path();
  files.rig = FirstThere({run / "rig.yaml", root / "rig.yaml"});
  if (!record.empty()) {
    const RunOrigin origin = ReadRunOrigin(root);
    files.left_camera = origin.left_camera;
    files.right_camera = origin.right_camera;
  }
  return files;
}

MotionData ReadMotionData(const MotionFiles& files, std::size_t max_joint_frames) {
  MotionData data;
  for (PoseSample& pose : ReadPosesCsv(files.poses)) {
    data.frames.emplace_back().pose = pose;
  }
  if (files.balls.empty()) return data;
  const fs::path folder = files.poses.parent_path();
  if (files.rig.empty() || files.body.empty()) {
    throw UserError((folder / (files.rig.empty() ? "rig.yaml" : "body.yaml")).string() +
                    ": no such file, expected the one that the run was measured with (balls.csv "
                    "cannot be understood without)");
  }
  data.rig = ReadRig(files.rig);
  data.left_camera = CameraIndex(data.rig, files.left_camera, 0, files.rig);
  data.right_camera = CameraIndex(data.rig, files.right_camera, 1, files.rig);
  const Body body = ReadBody(files.body);
  SetBalls(body, data);
  BallsFile(files.balls, body).ReadInto(WantedFrames(data.frames, max_joint_frames), data.frames);
  return data;
}

MotionData ReadMotionData(const fs::path& run) { return ReadMotionData(MotionFiles::In(run)); }

}  // namespace stereomotion
