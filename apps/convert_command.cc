#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <filesystem>
#include <map>
#include <memory>

#include "commands.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/rig_export.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/rig_writer.h"
#include "stereomotion/io/write_file.h"
#include "version.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string input, second_input;
  std::string to, output;
  std::vector<std::string> image_sizes;
  std::string dlt_pixels, dlt_unit;
  bool drop_distortion = false;
  bool force = false;
};

const std::map<std::string, RigFormat>& Formats() {
  static const std::map<std::string, RigFormat> formats = {{"opencv-yaml", RigFormat::kOpenCvYaml},
                                                           {"opencv-xml", RigFormat::kOpenCvXml},
                                                           {"kalibr", RigFormat::kKalibr},
                                                           {"anipose", RigFormat::kAnipose},
                                                           {"ros", RigFormat::kRos},
                                                           {"dlt", RigFormat::kDlt}};
  return formats;
}

const std::map<std::string, DltPixels>& PixelNames() {
  static const std::map<std::string, DltPixels> names = {{"zero-based", DltPixels::kZeroBased},
                                                         {"dltdv8", DltPixels::kDltdv8},
                                                         {"dltdv5", DltPixels::kDltdv5}};
  return names;
}

const std::map<std::string, double>& MmPerUnit() {
  static const std::map<std::string, double> units = {{"mm", 1}, {"cm", 10}, {"m", 1000}};
  return units;
}

template <class Value>
std::vector<std::string> Keys(const std::map<std::string, Value>& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

template <class Value>
Value Chosen(const std::map<std::string, Value>& map, const std::string& key, Value otherwise) {
  return key.empty() ? otherwise : map.at(key);
}

Eigen::Vector2i ParseSize(const std::string& text) {
  constexpr int kLargestSidePx = 65536;
  Eigen::Vector2i size_px(0, 0);
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size_px[0]);
  const bool separated = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = std::from_chars(separated ? width.ptr + 1 : end, end, size_px[1]);
  const bool whole = separated && height.ec == std::errc() && height.ptr == end;
  if (!whole || size_px.minCoeff() < 1 || size_px.maxCoeff() > kLargestSidePx) {
    throw UserError(
        fmt::format("--image-size: found '{}', expected width and height as 1280x1024", text));
  }
  return size_px;
}

// An option that changes nothing is a misunderstanding.
void RefuseUnused(bool used, bool given, const std::string& option, const std::string& use) {
  if (given && !used) throw UserError(option + " is not used here: it belongs to " + use);
}

Rig ReadDlt(const ConvertOptions& options) {
  if (options.image_sizes.empty()) {
    throw UserError(options.input +
                    ": DLT coefficients hold no image size; give --image-size WIDTHxHEIGHT (once "
                    "for all cameras, or once for each, in order)");
  }
  std::vector<Eigen::Vector2i> sizes_px;
  for (const std::string& text : options.image_sizes) sizes_px.push_back(ParseSize(text));
  const ImportedRig imported =
      ReadDltCsv(options.input, sizes_px,
                 {Chosen(PixelNames(), options.dlt_pixels, DltPixels::kZeroBased),
                  Chosen(MmPerUnit(), options.dlt_unit, 1.0)});
  for (const std::string& note : imported.notes) spdlog::warn("{}", note);
  return imported.rig;
}

Rig ReadInput(const ConvertOptions& options) {
  const bool pair = !options.second_input.empty();
  const bool dlt = !pair && LooksLikeDlt(options.input);
  RefuseUnused(dlt, !options.image_sizes.empty(), "--image-size", "DLT coefficients that are read");
  RefuseUnused(dlt, !options.dlt_unit.empty(), "--dlt-unit", "DLT coefficients that are read");
  RefuseUnused(dlt || options.to == "dlt", !options.dlt_pixels.empty(), "--dlt-pixels",
               "DLT coefficients");
  if (pair) return ReadRosCameraInfo(options.input, options.second_input);
  return dlt ? ReadDlt(options) : ReadRig(options.input);
}

RigExport Export(const ConvertOptions& options, const Rig& rig) {
  if (options.to == "rig") {
    RefuseUnused(false, options.drop_distortion, "--drop-distortion", "kalibr and dlt");
    CalibrationRecord record;
    record.program = std::string("stereomotion ") + kVersion;
    record.source = options.input;
    return {{{"", RigYaml(rig, record)}}, {}};
  }
  return ExportRig(
      rig, Formats().at(options.to),
      {options.drop_distortion, Chosen(PixelNames(), options.dlt_pixels, DltPixels::kZeroBased)});
}

void CheckOutput(const ConvertOptions& options, const fs::path& file) {
  std::error_code error;
  for (const std::string& input : {options.input, options.second_input}) {
    if (!input.empty() && fs::equivalent(input, file, error)) {
      throw UserError(file.string() + ": is the input, expected another --output");
    }
  }
  if (fs::is_directory(file, error)) {
    throw UserError(file.string() + ": is a folder, expected a file (--output)");
  }
  if (fs::is_regular_file(file, error) && !options.force) {
    throw UserError(file.string() + ": exists; give --force to overwrite, or another --output");
  }
}

int RunConvert(const ConvertOptions& options) {
  const RigExport result = Export(options, ReadInput(options));
  const fs::path output = options.output;
  const bool folder = !result.files.front().name.empty();
  if (folder && fs::is_regular_file(output)) {
    throw UserError(options.output + ": is a file, expected a folder for left.yaml and right.yaml");
  }
  const auto path = [&](const ExportedFile& file) { return folder ? output / file.name : output; };
  for (const ExportedFile& file : result.files) CheckOutput(options, path(file));
  std::error_code error;
  if (folder) fs::create_directories(output, error);
  if (error) throw OutputError(options.output + ": cannot be created: " + error.message());
  for (const ExportedFile& file : result.files) WriteFileAtomically(path(file), file.text);
  for (const std::string& note : result.notes) spdlog::warn("{}", note);
  fmt::print("{}\n", options.output);
  return kDone;
}

void AddDltOptions(CLI::App& convert, ConvertOptions& options) {
  convert
      .add_option("--image-size", options.image_sizes,
                  "DLT in: WIDTHxHEIGHT, once for all cameras or once for each")
      ->allow_extra_args(false);
  convert
      .add_option("--dlt-pixels", options.dlt_pixels,
                  "DLT: what u, v are counted from (default zero-based; docs/conventions.md)")
      ->check(CLI::IsMember(Keys(PixelNames())));
  convert.add_option("--dlt-unit", options.dlt_unit, "DLT in: length unit (default mm)")
      ->check(CLI::IsMember(Keys(MmPerUnit())));
}

}  // namespace

Run AddConvertCommand(CLI::App& app) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* convert = app.add_subcommand("convert", "Converts a calibrated rig between formats");
  convert
      ->add_option("input", options->input,
                   "rig.yaml, OpenCV, Kalibr, anipose, DLT csv, or the left ROS camera_info")
      ->required();
  convert->add_option("second", options->second_input, "The right ROS camera_info");
  std::vector<std::string> formats = Keys(Formats());
  formats.emplace_back("rig");
  convert->add_option("--to", options->to, "What is written")
      ->required()
      ->check(CLI::IsMember(formats));
  convert->add_option("--output", options->output, "File; for ros the folder of two files")
      ->required();
  AddDltOptions(*convert, *options);
  convert->add_flag("--drop-distortion", options->drop_distortion,
                    "Leave out the distortion that the format cannot hold (kalibr: k3; dlt: all)");
  convert->add_flag("--force", options->force, "Overwrite an existing output");
  convert->footer(
      "Examples: stereomotion convert rig.yaml --to opencv-yaml --output stereo.yml\n"
      "          stereomotion convert dlt.csv --image-size 1280x1024 --to rig --output rig.yaml");
  return [options](const CommonOptions&) { return RunConvert(*options); };
}

}  // namespace stereomotion::app
