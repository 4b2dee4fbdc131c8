// An environment's tables in device memory.
#pragma once

#include "gpu/cuda/runtime/device_array.h"
#include "gpu/scene/environment_view.h"

namespace weir {

class DeviceEnvironment {
 public:
  /// Copies the tables that `host` (host pointers, present) points to.
  explicit DeviceEnvironment(const EnvironmentView& host)
      : view_(host),
        radiance_(std::span(host.radiance, static_cast<std::size_t>(host.index(host.height, 0)))),
        rows_(std::span(host.rows, static_cast<std::size_t>(host.height) + 1)),
        columns_(std::span(host.columns, static_cast<std::size_t>(host.column_bounds(host.height)))) {
    view_.radiance = radiance_.data();
    view_.rows = rows_.data();
    view_.columns = columns_.data();
  }

  /// Returns the environment with device pointers.
  const EnvironmentView& view() const { return view_; }

 private:
  EnvironmentView view_;
  DeviceArray<Float3> radiance_;
  DeviceArray<std::uint32_t> rows_;
  DeviceArray<std::uint32_t> columns_;
};

}  // namespace weir
