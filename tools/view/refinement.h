// Refines a still picture until it is converged: first a small picture, then whole pictures with more and more samples
// per pixel. Each pass has its own random numbers, so that the mean of the passes equals one picture with all samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "format/sidecar/scene.h"
#include "gpu/image/image.h"
#include "gpu/render/backend.h"
#include "gpu/render/kept_pixels.h"
#include "tools/view/frame_pace.h"

namespace weir {

/// Returns the samples per pixel at which a picture is not refined any further.
std::uint32_t converged_samples(RenderMode mode);

struct RefinementPass {
  FrameSize size;          ///< size and samples of this pass
  std::uint64_t seed = 0;  ///< seed of its random numbers
  bool whole = false;      ///< full size: the pass is added to the previous whole passes
  bool shown = false;      ///< a picture is sent after this pass
};

/// The part that is done of a pass that made room for another viewer.
struct UnfinishedPass {
  using Progress = std::pair<std::size_t, std::uint64_t>;

  std::vector<Image> layers;  ///< finished layers
  GridFrame frame;            ///< frame of the first layer's file
  KeptPixels next_layer;      ///< pixels done of the next layer

  /// Returns a measure that grows with everything that is drawn.
  Progress progress() const { return {layers.size(), next_layer.drawn()}; }
};

class Refinement {
 public:
  Refinement() = default;
  /// Refines `layers` pictures of `width` x `height`. The width of the first pass is the share `first`, in (0, 1].
  Refinement(std::int32_t width, std::int32_t height, int layers, double first, std::uint32_t samples);

  /// Returns the next pass; nullopt if the picture is converged.
  std::optional<RefinementPass> next() const;
  /// Returns the part already drawn of the pass that next() returns. add() empties it.
  UnfinishedPass& unfinished() { return unfinished_; }
  /// Adds a finished pass. `layers` are its mean pictures, each of pass.size.
  void add(const RefinementPass& pass, const std::vector<Image>& layers);

  /// Returns all layers stacked: of the last small pass, or the mean of the whole passes.
  Image picture() const;
  std::uint32_t samples() const { return samples_; }  ///< samples per pixel of the whole picture so far
  std::uint32_t of() const { return of_; }

 private:
  std::int32_t width_ = 1;
  std::int32_t height_ = 1;
  double share_ = 2;  ///< share of the width of the next pass; above 1: whole passes
  std::uint32_t of_ = 0;
  std::uint32_t samples_ = 0;
  std::vector<Image> layers_;  ///< a small pass as it is, or sums of whole passes
  UnfinishedPass unfinished_;
};

/// Returns pictures of equal width, stacked.
Image stacked(const std::vector<Image>& layers);

}  // namespace weir
