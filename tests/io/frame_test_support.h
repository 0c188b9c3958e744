#pragma once

#include <string>

#include "stereomotion/io/frame_file.h"
#include "tests/io/io_test_support.h"

namespace stereomotion::testing {

/// Eight points in depth, as a frame of control points carries them.
inline std::string EightPoints() {
  return "x0,0,0,0\nx1,400,0,0\nx2,400,300,0\nx3,0,300,0\n"
         "x4,0,0,200\nx5,400,0,210\nx6,400,300,220\nx7,0,300,190\n";
}

/// Holds a frame.yaml in a folder of its own, with two empty images a camera, points and seeds.
class FrameFolder {
 public:
  std::string target = "  type: control_points\n  ball_diameter_mm: 16\n  points: points.csv\n";
  std::string cam0 = "images: cam0/*.png, seeds: seeds.csv";
  std::string cam1 = "images: cam1/*.png";
  std::string end;

  FrameFolder() {
    for (const char* name : {"cam0/1.png", "cam0/2.png", "cam1/1.png", "cam1/2.png"}) Write(name);
    Write("points.csv", "id,x_mm,y_mm,z_mm\n" + EightPoints());
    Write("seeds.csv", "id,u_px,v_px\nx0,1,1\nx1,50,1\nx2,50,40\nx3,1,40\nx4,10,10\nx5,40,10\n");
  }
  std::filesystem::path Write(const std::string& name, const std::string& text = "") const {
    return folder_.Write(name, text);
  }
  [[nodiscard]] FrameFile Read() const {
    return ReadFrame(Write("frame.yaml", "format: stereomotion-frame/1\ntarget:\n" + target +
                                             "cameras:\n  - {name: cam0, " + cam0 +
                                             "}\n  - {name: cam1, " + cam1 + "}\n" + end));
  }
  [[nodiscard]] std::string ErrorText() const {
    return Error([&] { return Read(); });
  }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

}  // namespace stereomotion::testing
