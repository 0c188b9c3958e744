#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

namespace stereomotion {

/// Collects what a person should know, each thing once; safe from any thread.
class WarningList {
 public:
  /// An empty text is no warning.
  void Add(const std::string& warning) {
    const std::lock_guard lock(mutex_);
    const bool known = std::find(warnings_.begin(), warnings_.end(), warning) != warnings_.end();
    if (!warning.empty() && !known) warnings_.push_back(warning);
  }
  [[nodiscard]] std::vector<std::string> All() const {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> warnings_;
};

}  // namespace stereomotion
