// A still picture on its way to a converged one: first small, then whole with more and more samples a pixel, each pass
// with random numbers of its own, so that their mean is that of one picture with all samples.
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

/// Samples a pixel of a picture that is not refined any further.
std::uint32_t converged_samples(RenderMode mode);

struct RefinementPass {
  FrameSize size;          ///< and samples of this pass
  std::uint64_t seed = 0;  ///< of its random numbers
  bool whole = false;      ///< of full size: it is added to those before
  bool shown = false;      ///< a picture goes out after it
};

/// What there is of a pass that made room for another viewer.
struct UnfinishedPass {
  using Progress = std::pair<std::size_t, std::uint64_t>;

  std::vector<Image> layers;  ///< that are whole
  GridFrame frame;            ///< of the first one's file
  KeptPixels next_layer;      ///< of the one after them

  /// Grows with all that is drawn.
  Progress progress() const { return {layers.size(), next_layer.drawn()}; }
};

class Refinement {
 public:
  Refinement() = default;
  /// Of `layers` pictures of `width` x `height`; the first pass is `first` times as wide, in (0, 1].
  Refinement(std::int32_t width, std::int32_t height, int layers, double first, std::uint32_t samples);

  /// None: it is converged.
  std::optional<RefinementPass> next() const;
  /// What was drawn of the pass that next() asks for. add() leaves it empty.
  UnfinishedPass& unfinished() { return unfinished_; }
  /// A pass is done; `layers` are its mean pictures, each of pass.size.
  void add(const RefinementPass& pass, const std::vector<Image>& layers);

  /// All layers above each other; the last small pass, or the mean of the whole ones.
  Image picture() const;
  std::uint32_t samples() const { return samples_; }  ///< of a pixel of the whole picture, so far
  std::uint32_t of() const { return of_; }

 private:
  std::int32_t width_ = 1;
  std::int32_t height_ = 1;
  double share_ = 2;  ///< of the next pass; above 1: whole ones
  std::uint32_t of_ = 0;
  std::uint32_t samples_ = 0;
  std::vector<Image> layers_;  ///< of a small pass as it is; sums of whole ones
  UnfinishedPass unfinished_;
};

/// Pictures of one width above each other.
Image stacked(const std::vector<Image>& layers);

}  // namespace weir
