#include <array>
#include <string>
#include <utility>

#include "report_verdict.h"

namespace stereomotion {
namespace {

// In the order in which docs/formats.md lists them.
using Pair = std::pair<const char*, const char*>;
constexpr std::array<Pair, 26> kAdvice = {{
    {"outliers",
     "Look at these image points: covered, exchanged ids, reflections? If the ids are "
     "right and many points of one view are listed, take that view again."},
    {"intrinsics_reduced",
     "Survey more control points, or calibrate the lens with a board first "
     "and give its values as `initial` with `free: []`."},
    {"systematic_residuals",
     "Do not trust the stated uncertainties. Estimate more of the lens "
     "(`free`), look for glass or water between camera and target, and "
     "for errors of the target's coordinates."},
    {"image_noise",
     "Look for blur, vibration, uneven light or saturated balls; the uncertainties "
     "given here contain the larger noise already."},
    {"survey_sigma",
     "Give the survey's true `sigma_mm`, or survey again; the uncertainties given "
     "here contain the scale already."},
    {"ball_size", "Check `ball_diameter_mm` and the unit of the coordinates: both are in mm."},
    {"implausible_distance", "Check the unit of the target's lengths: mm."},
    {"blurred_view",
     "Hold the target still, shorten the exposure or focus again, or leave the view "
     "out."},
    {"poor_coverage",
     "Move the target until it has been seen all over each image, also in the "
     "corners."},
    {"no_depth_variation", "Move the target towards the cameras and away, or use a deeper one."},
    {"few_views", "Take more views: 10 to 30."},
    {"similar_views", "Tilt the board by 30 to 45 degrees, in different directions."},
    {"weak_focal_length",
     "Add depth and tilt, or give a known focal length as `initial` and leave "
     "it out of `free`."},
    {"distortion_undetermined",
     "Nothing to do if you measure only where the target was seen; else show it "
     "further out in the images."},
    {"implausible_lens",
     "Do not measure with this rig: add points, check their ids, or give a known lens "
     "(`initial`, `free: []`)."},
    {"board_shape",
     "Mount the board on something flat and stiff; its shape is in the fit already."},
    {"swapped_cameras", "Look whether each camera's images are its own."},
    {"contradicting_seeds", "Correct the ids in the seeds file; these seeds were not used."},
    {"noise_unknown", "Harmless; more images of balls tell the noise."},
    {"points_not_found", "Look there: a covered ball, or a wrong coordinate or id."},
    {"wrong_pairs", "Make sure that image n of each camera shows the same moment."},
    {"contradicting_view", "Take that view again, or leave it out."},
    {"few_points", "Survey at least eight balls, better 24, and keep some as check points."},
    {"world_view", "Take the view whose board shall be the world as the first one."},
    {"board_not_found", "Leave the image out, or check rows, columns and light."},
    {"wand_not_found", "Leave the image out, or check that all balls are in it and bright."},
}};

}  // namespace

std::string Advice(const std::string& warning) {
  for (const auto& [name, text] : kAdvice) {
    if (warning == name) return text;
  }
  return "";
}

}  // namespace stereomotion
