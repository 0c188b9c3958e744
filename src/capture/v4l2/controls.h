#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node.h"

namespace stereomotion::v4l2 {

/// A control of a camera, as its driver describes it.
struct Control {
  std::uint32_t id = 0;
  std::uint32_t type = 0;   ///< V4L2_CTRL_TYPE_…
  std::uint32_t flags = 0;  ///< V4L2_CTRL_FLAG_…
  std::string name;         ///< as the driver spells it: "Power Line Frequency"
  std::int64_t lowest = 0, highest = 0;
  std::uint64_t step = 1;
  std::map<std::int64_t, std::string> choices;  ///< of menus
};

/// Reads and sets the controls of a camera, by id or by name.
class Controls {
 public:
  /// Lists the controls; there are none where the driver has none.
  explicit Controls(const Node& node);

  /// Finds a control; null: the camera has none such.
  [[nodiscard]] const Control* Find(std::uint32_t id) const;
  /// By name, capitals and what is no letter or digit aside: "power_line_frequency".
  [[nodiscard]] const Control* Find(const std::string& name) const;
  /// Reads a value; nothing: it cannot be read.
  [[nodiscard]] std::optional<std::int64_t> Get(const Control& control) const;

  /// Sets a number and reads it back. Throws `DeviceError` where it is out of range, read-only or
  /// refused; the value that the driver took instead is returned.
  std::int64_t Set(const Control& control, std::int64_t value) const;
  /// Sets controls by name, to a number, "on", "off" or a menu's text. Throws `DeviceError`: no
  /// such control, no such choice, refused, or changed by the driver.
  void SetByName(const std::map<std::string, std::string>& wanted) const;

 private:
  void SetText(const Control& control, const std::string& text) const;
  [[nodiscard]] std::string Start(const Control& control) const;

  const Node& node_;
  std::vector<Control> controls_;
};

/// Writes the name of a control as a user types it: "Power Line Frequency" → power_line_frequency.
std::string ControlKey(const std::string& name);

}  // namespace stereomotion::v4l2
