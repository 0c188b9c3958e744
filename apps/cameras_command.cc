#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion::app {
namespace {

constexpr const char* kNoneFound =
    "stereomotion: no camera found. Check\n"
    "  GigE Vision   power and link lights; the network card's address in the camera's network\n"
    "                (169.254.x.y/16 where nobody gives addresses); a firewall that stops UDP\n"
    "                port 3956. A camera behind a router is not found, but opens by its address:\n"
    "                --left aravis:192.168.1.10\n"
    "  USB3 Vision   that you may use it (udev rule), and that it hangs on a USB 3 port\n"
    "  V4L2          that /dev/video0 is there, and that you are in the group video\n"
    "docs/cameras.md has more.\n";

nlohmann::ordered_json ToJson(const DeviceInfo& camera) {
  const auto number = [](auto value) {
    return value > 0 ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  return {{"uri", camera.uri},
          {"protocol", camera.protocol},
          {"vendor", camera.vendor},
          {"model", camera.model},
          {"serial", camera.serial},
          {"address", camera.address},
          {"pixel_formats", camera.pixel_formats},
          {"width_px", number(camera.width_px)},
          {"height_px", number(camera.height_px)},
          {"rate_hz", number(camera.rate_hz)},
          {"problem", camera.problem}};
}

void PrintJson(const std::vector<DeviceInfo>& cameras) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const DeviceInfo& camera : cameras) list.push_back(ToJson(camera));
  // What a camera calls itself need not be valid UTF-8.
  using Json = nlohmann::ordered_json;
  fmt::print("{}\n", list.dump(2, ' ', false, Json::error_handler_t::replace));
}

// Counted in characters: what a camera calls itself may have umlauts.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::vector<std::string> RowOf(const DeviceInfo& camera) {
  const auto or_dash = [](const std::string& text) { return text.empty() ? "-" : text; };
  const bool sized = camera.width_px > 0;
  return {camera.uri,
          camera.protocol,
          or_dash(camera.vendor + (camera.vendor.empty() ? "" : " ") + camera.model),
          or_dash(camera.serial),
          or_dash(camera.address),
          sized ? fmt::format("{} x {}", camera.width_px, camera.height_px) : "-",
          camera.rate_hz > 0 ? fmt::format("{:.4g} Hz", camera.rate_hz) : "-"};
}

void PrintTable(const std::vector<DeviceInfo>& cameras) {
  std::vector<std::vector<std::string>> rows = {
      {"CAM", "PROTOCOL", "MODEL", "SERIAL", "ADDRESS", "SIZE px", "RATE"}};
  for (const DeviceInfo& camera : cameras) rows.push_back(RowOf(camera));
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      line += rows[r][i] + std::string(widths[i] - Width(rows[r][i]) + 2, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
    if (r == 0) continue;
    const DeviceInfo& camera = cameras[r - 1];
    if (!camera.pixel_formats.empty()) {
      fmt::print("  formats: {}\n", fmt::join(camera.pixel_formats, ", "));
    }
    if (!camera.problem.empty()) fmt::print("  problem: {}\n", camera.problem);
  }
}

int RunCameras(bool json) {
  const std::vector<DeviceInfo> cameras = ListCameras();
  if (json) {
    PrintJson(cameras);
  } else if (!cameras.empty()) {
    PrintTable(cameras);
  }
  if (!cameras.empty()) return kDone;
  fmt::print(stderr, kNoneFound);
  return kNoAnswer;
}

}  // namespace

Run AddCamerasCommand(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* cameras =
      app.add_subcommand("cameras", "Lists GigE Vision, USB3 Vision and V4L2 cameras");
  cameras->add_flag("--json", *json, "As JSON, for programs");
  cameras->footer(
      "The first column is what --left and --right of track, record and check take.\n"
      "Exit code 1: none found.");
  return [json](const CommonOptions&) { return RunCameras(*json); };
}

}  // namespace stereomotion::app
