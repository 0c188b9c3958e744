#pragma once

#include <arv.h>

#include <memory>
#include <string>

namespace stereomotion {

/// Lets go of a GObject.
struct GObjectUnref {
  void operator()(void* object) const { g_object_unref(object); }
};
template <class T>
using GObjectPtr = std::unique_ptr<T, GObjectUnref>;

/// Frees what a C function allocated by `g_malloc`.
struct GFree {
  void operator()(void* memory) const { g_free(memory); }
};
template <class T>
using GMemory = std::unique_ptr<T, GFree>;

/// Receives the error of one call after another; each starts from none.
class GErrorSlot {
 public:
  GErrorSlot() = default;
  ~GErrorSlot() { g_clear_error(&error_); }
  GErrorSlot(const GErrorSlot&) = delete;
  GErrorSlot& operator=(const GErrorSlot&) = delete;
  /// What to hand to a call; forgets the last error.
  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  [[nodiscard]] std::string text() const { return error_ == nullptr ? "" : error_->message; }

 private:
  GError* error_ = nullptr;
};

/// A text that may be absent.
inline std::string TextOf(const char* text) { return text == nullptr ? "" : text; }

}  // namespace stereomotion
