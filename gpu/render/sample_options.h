// How much of a picture to render, how progress is reported, and how to stop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "gpu/render/kept_pixels.h"

namespace weir {

struct SampleOptions {
  std::uint32_t samples = 1;                  ///< per pixel
  const std::atomic<bool>* cancel = nullptr;  ///< checked every few milliseconds of work
  /// Called with the number of pixel samples done so far, from any thread, one call at a time.
  std::function<void(std::uint64_t)> progress = {};
  /// For a volume that is paged (a cache on a device): a draft does not wait for missing data but uses data near it.
  /// The next picture finds the missing data. For a moving camera. `cancel` does not end a draft earlier.
  bool draft = false;
  /// If `cancel` is set, this receives what was drawn, and the next call for the same picture (volume, scene, options
  /// and samples) continues it. It is empty after a complete picture. May be null. A device keeps nothing.
  KeptPixels* kept = nullptr;
};

}  // namespace weir
