// How much of a picture to render, how progress is reported, and how to stop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "gpu/render/kept_pixels.h"

namespace weir {

struct SampleOptions {
  std::uint32_t samples = 1;                  ///< per pixel
  const std::atomic<bool>* cancel = nullptr;  ///< looked at every few milliseconds of work
  /// Called with the pixel samples done so far, from any thread, one at a time.
  std::function<void(std::uint64_t)> progress = {};
  /// Of a volume that comes and goes (a cache on a device): does not wait for what is missing, which the next picture
  /// finds there, but does with what is near it. For a camera that moves; ends no sooner for `cancel`.
  bool draft = false;
  /// Where `cancel` was set, what was drawn stays here, and the next call for the same picture (volume, scene, options
  /// and samples) begins with it. Empty after a picture that is whole. May be null; a device keeps nothing.
  KeptPixels* kept = nullptr;
};

}  // namespace weir
