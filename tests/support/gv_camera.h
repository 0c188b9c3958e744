#pragma once

#include <memory>

#include "tests/support/gv_plan.h"

namespace stereomotion::testing {

/// A GigE Vision camera on this host's network: Aravis' fake one, with our images, numbers and
/// times. Serves from construction to destruction.
class GvCamera {
 public:
  /// Throws `std::runtime_error` where the address cannot be served.
  explicit GvCamera(const GvPlan& plan);
  ~GvCamera();
  GvCamera(const GvCamera&) = delete;
  GvCamera& operator=(const GvCamera&) = delete;

  /// Counts the frames that were sent.
  [[nodiscard]] std::int64_t sent() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stereomotion::testing
