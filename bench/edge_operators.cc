#include "bench/edge_operators.h"

#include <cmath>
#include <memory>
#include <utility>

#include "src/detection/wavelet_locator.h"
#include "src/detection/wavelet_maxima.h"
#include "src/detection/wavelet_transform.h"

namespace stereomotion::bench {
namespace {

EdgeResponse Blank(const WaveletPlane& image, double offset_px, int border_px) {
  EdgeResponse response;
  response.offset_px = offset_px;
  response.border_px = border_px;
  for (WaveletPlane* plane : {&response.modulus, &response.u, &response.v}) {
    plane->Resize(image.width, image.height);
    plane->Fill(0);
  }
  return response;
}

void SetModulus(EdgeResponse& response) {
  for (std::size_t i = 0; i < response.modulus.values.size(); ++i) {
    response.modulus.values[i] = std::hypot(response.u.values[i], response.v.values[i]);
  }
}

/// Roberts' cross: two diagonal differences, turned onto the axes.
EdgeResponse Roberts(const WaveletPlane& image) {
  EdgeResponse response = Blank(image, 0.5, 1);
  for (int j = 0; j + 1 < image.height; ++j) {
    for (int i = 0; i + 1 < image.width; ++i) {
      const float falling = image.At(i + 1, j + 1) - image.At(i, j);
      const float rising = image.At(i + 1, j) - image.At(i, j + 1);
      response.u.Row(j)[i] = 0.5F * (falling + rising);
      response.v.Row(j)[i] = 0.5F * (falling - rising);
    }
  }
  SetModulus(response);
  return response;
}

/// Gradient by a separable odd kernel: `derivative` along, `smoothing` across, both of odd length.
EdgeResponse Separable(const WaveletPlane& image, const std::vector<double>& derivative,
                       const std::vector<double>& smoothing) {
  const int reach = static_cast<int>(derivative.size() / 2);
  EdgeResponse response = Blank(image, 0, reach);
  for (int j = reach; j < image.height - reach; ++j) {
    for (int i = reach; i < image.width - reach; ++i) {
      double along_u = 0;
      double along_v = 0;
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          const auto column = static_cast<std::size_t>(x + reach);
          const auto row = static_cast<std::size_t>(y + reach);
          along_u += derivative[column] * smoothing[row] * image.At(i + x, j + y);
          along_v += smoothing[column] * derivative[row] * image.At(i + x, j + y);
        }
      }
      response.u.Row(j)[i] = static_cast<float>(along_u);
      response.v.Row(j)[i] = static_cast<float>(along_v);
    }
  }
  SetModulus(response);
  return response;
}

/// Canny's filter: the derivative of a Gaussian, cut at four σ.
EdgeResponse Canny(const WaveletPlane& image, double sigma_px) {
  const int reach = static_cast<int>(std::ceil(4 * sigma_px));
  std::vector<double> smoothing, derivative;
  double sum = 0;
  double ramp = 0;
  for (int x = -reach; x <= reach; ++x) {
    const double gauss = std::exp(-0.5 * x * x / (sigma_px * sigma_px));
    smoothing.push_back(gauss);
    derivative.push_back(x * gauss);
    sum += gauss;
    ramp += x * x * gauss;
  }
  for (double& weight : smoothing) weight /= sum;
  for (double& weight : derivative) weight /= ramp;
  return Separable(image, derivative, smoothing);
}

EdgeResponse WaveletProduct(const WaveletPlane& image, int fine_scale) {
  const auto shared = std::make_shared<WaveletTransform>();
  shared->Forward(image);
  const WaveletTransform& transform = *shared;
  EdgeResponse response = Blank(image, 0.5, WaveletTransform::Border(fine_scale + 1));
  const WaveletScale& fine = transform.scale(fine_scale);
  const WaveletScale& coarse = transform.scale(fine_scale + 1);
  MultiplyScales(fine, coarse, response.modulus);
  // The gradient's direction is that of both scales together.
  for (std::size_t i = 0; i < response.u.values.size(); ++i) {
    response.u.values[i] = fine.u.values[i] + coarse.u.values[i];
    response.v.values[i] = fine.v.values[i] + coarse.v.values[i];
  }
  if (fine_scale != kFineScale) return response;
  // The detector's scales: as it does, along the ray.
  response.refine = [shared](const EdgeMaximum& at) {
    static const EdgeLocator locator;
    constexpr double kReach_px = 1.5;
    const auto edge =
        locator.Locate(*shared, {at.u_px, at.v_px}, {-at.gradient_u, -at.gradient_v}, kReach_px);
    EdgeMaximum refined = at;
    if (!edge) return refined;
    refined.u_px = edge->place.x();
    refined.v_px = edge->place.y();
    return refined;
  };
  return response;
}

/// Reads the modulus where a line through an entry crosses the frame of its neighbours.
double Across(const EdgeResponse& response, int i, int j, double step_u, double step_v) {
  const double x = i + step_u;
  const double y = j + step_v;
  const int left = static_cast<int>(std::floor(x));
  const int top = static_cast<int>(std::floor(y));
  const double a = x - left;
  const double b = y - top;
  const WaveletPlane& m = response.modulus;
  return (1 - b) * ((1 - a) * m.At(left, top) + a * m.At(left + 1, top)) +
         b * ((1 - a) * m.At(left, top + 1) + a * m.At(left + 1, top + 1));
}

}  // namespace

std::vector<EdgeOperator> AllEdgeOperators() {
  std::vector<EdgeOperator> operators;
  operators.push_back({"Roberts", Roberts});
  operators.push_back({"Prewitt", [](const WaveletPlane& image) {
                         return Separable(image, {-0.5, 0, 0.5}, {1 / 3.0, 1 / 3.0, 1 / 3.0});
                       }});
  operators.push_back({"Sobel", [](const WaveletPlane& image) {
                         return Separable(image, {-0.5, 0, 0.5}, {0.25, 0.5, 0.25});
                       }});
  // 1: the usual one; 1.4: the kernel of textbooks; 2: as wide as the wavelets of 2³.
  for (const auto& [name, sigma_px] :
       {std::pair("Canny σ 1", 1.0), std::pair("Canny σ 1.4", 1.4), std::pair("Canny σ 2", 2.0)}) {
    operators.push_back(
        {name, [sigma = sigma_px](const WaveletPlane& image) { return Canny(image, sigma); }});
  }
  operators.push_back(
      {"wavelet 2¹×2²", [](const WaveletPlane& image) { return WaveletProduct(image, 1); }});
  operators.push_back(
      {kDetectorScales, [](const WaveletPlane& image) { return WaveletProduct(image, 2); }});
  return operators;
}

std::vector<EdgeMaximum> FindMaxima(const EdgeResponse& response, double threshold) {
  std::vector<EdgeMaximum> maxima;
  const WaveletPlane& m = response.modulus;
  const int border = response.border_px + 2;  // 2: the neighbours' interpolation
  for (int j = border; j < m.height - border; ++j) {
    for (int i = border; i < m.width - border; ++i) {
      const double here = m.At(i, j);
      if (here <= threshold) continue;
      const double u = response.u.At(i, j);
      const double v = response.v.At(i, j);
      const double major = std::max(std::abs(u), std::abs(v));
      const double ahead = Across(response, i, j, u / major, v / major);
      const double behind = Across(response, i, j, -u / major, -v / major);
      if (here <= ahead || here < behind) continue;
      const double shift = 0.5 * (behind - ahead) / (ahead + behind - 2 * here);
      const double length = std::hypot(u, v);
      maxima.push_back({i + response.offset_px + shift * u / major,
                        j + response.offset_px + shift * v / major, here, u / length, v / length});
    }
  }
  return maxima;
}

void Refine(const EdgeResponse& response, std::vector<EdgeMaximum>& maxima) {
  if (!response.refine) return;
  for (EdgeMaximum& at : maxima) at = response.refine(at);
}

}  // namespace stereomotion::bench
