#include <cmath>
#include <opencv2/core.hpp>

#include "rig_formats.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

class Storage {
 public:
  explicit Storage(const std::filesystem::path& file) : file_(file.string()) {
    try {
      storage_.open(file_, cv::FileStorage::READ);
    } catch (const cv::Exception& error) {
      throw UserError(file_ + ": is not a valid OpenCV file (" + error.err + ")");
    }
    if (!storage_.isOpened()) throw UserError(file_ + ": cannot be read");
  }

  [[nodiscard]] bool Has(const std::string& key) const { return !storage_[key].empty(); }

  [[nodiscard]] cv::Mat Matrix(const std::string& key) const {
    if (!Has(key)) {
      throw UserError(file_ + ": the key '" + key +
                      "' is missing, expected K1 D1 K2 D2 R T (or M1 D1 M2 D2 R T) in one file");
    }
    cv::Mat matrix;
    try {
      storage_[key] >> matrix;
      matrix.convertTo(matrix, CV_64F);
    } catch (const cv::Exception&) {
      matrix.release();
    }
    if (matrix.empty() || !cv::checkRange(matrix)) {
      throw UserError(file_ + ": " + key + ": expected a matrix of finite numbers");
    }
    return matrix;
  }
  [[nodiscard]] cv::Mat Matrix(const std::string& key, int rows, int cols) const {
    cv::Mat matrix = Matrix(key);
    const bool vector = cols == 1 && matrix.total() == static_cast<std::size_t>(rows);
    if (!vector && (matrix.rows != rows || matrix.cols != cols)) {
      throw UserError(file_ + ": " + key + ": found " + std::to_string(matrix.rows) + " × " +
                      std::to_string(matrix.cols) + ", expected " + std::to_string(rows) + " × " +
                      std::to_string(cols));
    }
    return matrix.reshape(1, rows);
  }
  [[nodiscard]] cv::Size ImageSize() const {
    for (const char* key : {"image_size", "imageSize", "size", "image_size_px"}) {
      const cv::FileNode node = storage_[key];
      if (node.isSeq() && node.size() == 2)
        return {static_cast<int>(node[0]), static_cast<int>(node[1])};
    }
    for (const auto& [width, height] : {std::pair{"image_width", "image_height"},
                                        {"image_Width", "image_Height"},
                                        {"width", "height"}}) {
      if (Has(width) && Has(height)) {
        return {static_cast<int>(storage_[width]), static_cast<int>(storage_[height])};
      }
    }
    throw UserError(file_ + ": the image size is missing, expected image_size: [width, height]");
  }

 private:
  std::string file_;
  cv::FileStorage storage_;
};

RigCamera ReadCamera(const std::string& file, const Storage& storage, int number, cv::Size size) {
  const std::string digit = std::to_string(number);
  const std::string matrix_key = (storage.Has("M" + digit) ? "M" : "K") + digit;
  const std::string distortion_key = "D" + digit;
  const cv::Mat k = storage.Matrix(matrix_key, 3, 3);
  const cv::Mat d = storage.Matrix(distortion_key).reshape(1, 1);
  if (d.cols > 5 && cv::countNonZero(d.colRange(5, d.cols)) > 0) {
    throw UserError(file + ": " + distortion_key + ": found " + std::to_string(d.cols) +
                    " coefficients, expected k1 k2 p1 p2 k3 (the rational, thin-prism and tilted "
                    "models are not supported)");
  }
  if (std::abs(k.at<double>(0, 1)) > 1e-9 || k.at<double>(2, 2) != 1) {
    throw UserError(file + ": " + matrix_key + ": expected [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  const auto coefficient = [&](int i) { return i < d.cols ? d.at<double>(i) : 0.0; };
  RigCamera camera;
  camera.name = "cam" + std::to_string(number - 1);
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.model = {k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2),
                  k.at<double>(1, 2), coefficient(0),     coefficient(1),
                  coefficient(2),     coefficient(3),     coefficient(4)};
  return camera;
}

}  // namespace

// The world is the first camera's frame; lengths are taken as mm, the unit is not in the file.
Rig ReadOpenCvRig(const std::filesystem::path& file) {
  const Storage storage(file);
  const cv::Size size = storage.ImageSize();
  if (size.width < 1 || size.height < 1) throw UserError(file.string() + ": image size below 1 px");
  Rig rig;
  rig.cameras = {ReadCamera(file.string(), storage, 1, size),
                 ReadCamera(file.string(), storage, 2, size)};
  const cv::Mat r = storage.Matrix("R", 3, 3), t = storage.Matrix("T", 3, 1);
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_mm;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation(i, j) = r.at<double>(i, j);
    translation_mm[i] = t.at<double>(i);
  }
  rig.cameras[1].cam_from_world = MakeRigid(file.string() + ": R", rotation, translation_mm);
  return rig;
}

}  // namespace stereomotion
