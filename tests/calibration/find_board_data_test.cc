#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <tuple>

#include "stereomotion/calibration/find_board.h"
#include "tests/support/board_image.h"

namespace stereomotion {
namespace {

std::filesystem::path Shared() {
  const char* folder = std::getenv("STEREOMOTION_SHARED_DATA");
  return folder ? folder : STEREOMOTION_SOURCE_DIR "/../shared/data";
}

BoardView FindIn(const std::filesystem::path& file, const Target& target) {
  const cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  return FindBoard({image.data, image.cols, image.rows, static_cast<std::ptrdiff_t>(image.step),
                    PixelType::kGray8},
                   target);
}

/// Exact corners by (camera, frame, point).
std::map<std::tuple<int, int, int>, Eigen::Vector2d> ReadTruth(const std::filesystem::path& file) {
  std::map<std::tuple<int, int, int>, Eigen::Vector2d> truth_px;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream row(line);
    int frame = 0, camera = 0, tag = 0, corner = 0;
    double bx = 0, by = 0, bz = 0;
    Eigen::Vector2d pixel_px;
    row >> frame >> camera >> tag >> corner >> bx >> by >> bz >> pixel_px.x() >> pixel_px.y();
    truth_px[{camera, frame, 4 * tag + corner}] = pixel_px;
  }
  return truth_px;
}

TEST(FindBoardInRecordings, EveryTagCornerNearTheBound) {
  const auto folder = Shared() / "rendered/calib_tags";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  const auto truth_px = ReadTruth(folder / "truth/tags.csv");
  double error2 = 0, stated2 = 0;
  std::size_t count = 0;
  for (int camera = 0; camera < 2; ++camera) {
    for (int frame = 0; frame < 12; ++frame) {
      char name[32];
      std::snprintf(name, sizeof name, "cam%d/%06d.png", camera, frame);
      for (const BoardPoint& point : FindIn(folder / name, testing::TagBoard()).points) {
        error2 += (point.pixel_px - truth_px.at({camera, frame, point.point})).squaredNorm();
        stated2 += point.covariance_px2.trace();
        ++count;
      }
    }
  }
  EXPECT_EQ(count, truth_px.size());
  // Not at the bound: 1.27 of it was measured here, where boards of our own renderer give 0.99 to
  // 1.03 (find_board_monte_carlo_test). Views are off by up to 0.006 px, often alike in both
  // cameras; whether that is this recording's renderer or our model is not known. A guard only.
  EXPECT_LT(std::sqrt(error2 / stated2), std::sqrt(2.0));
}

TEST(FindBoardInRecordings, RealChessboardsAreFoundWhole) {
  const auto folder = Shared() / "real/board_opencv";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  Target target = testing::ChessBoard();
  target.spacing_mm = 25;
  target.points = MakeBoardPoints(target);
  std::size_t count = 0;
  int whole_pairs = 0;
  for (const int number : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14}) {
    std::size_t of_pair = 0;
    Eigen::Vector2d row[2];
    for (int side = 0; side < 2; ++side) {
      char name[32];
      std::snprintf(name, sizeof name, "%s%02d.jpg", side == 0 ? "left" : "right", number);
      const BoardView view = FindIn(folder / name, target);
      of_pair += view.points.size();
      if (view.points.size() == 54) {
        row[side] = view.points[8].pixel_px - view.points[0].pixel_px;
      }
    }
    count += of_pair;
    if (of_pair == 2 * 54) {
      ++whole_pairs;
      // The cameras stand side by side: a half turn of one labelling would show.
      EXPECT_GT(row[0].normalized().dot(row[1].normalized()), 0.9) << number;
    }
  }
  EXPECT_GE(whole_pairs, 11);
  EXPECT_GE(count, 13U * 108 * 97 / 100);
}

TEST(FindBoardInRecordings, PhotographsOfOtherTagsShowNoBoard) {
  // Tags of one id all over, on robots and cubes: doubled, so none is taken.
  const auto folder = Shared() / "real/tags_aprilrobotics/test/data";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  for (const char* name : {"33369213973_9d9bb4cc96_c.jpg", "34085369442_304b6bafd9_c.jpg",
                           "34139872896_defdb2f8d9_c.jpg"}) {
    const BoardView view = FindIn(folder / name, testing::TagBoard());
    EXPECT_TRUE(view.points.empty()) << name;
    EXPECT_NE(view.problem.find("tags of family tag36h11 found"), std::string::npos)
        << view.problem;
  }
}

}  // namespace
}  // namespace stereomotion
