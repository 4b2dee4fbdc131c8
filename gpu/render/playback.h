// A series of volumes as frames: while one step renders, the next one loads in a
// thread of its own and the frame before is written in another. At most two
// volumes are held at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "gpu/render/backend.h"

namespace weir {

struct PlaybackReport {
  std::size_t frames = 0;
  double total_s = 0;  ///< from the first load to the last frame written
  double load_s = 0;   ///< how long each stage worked; stages overlap
  double render_s = 0;
  double write_s = 0;
  double sustained = 0;  ///< frames per second from the first one written to the last; of all where there is one
  LoadSummary load;      ///< of the last step

  /// "load", "render" or "write": the stage that worked longest, which the others wait for.
  std::string_view limit() const;
};

/// Called with rising frame numbers, from a thread of its own, one at a time.
using FrameWriter = std::function<void(std::size_t frame, const Picture& picture)>;

/// Renders one frame of each of `files`, in order. Where `options` has no density_frame, it is the first step's. A step
/// that fails to load beside the one that is rendered, by an Error of kind io, for want of device memory say, is loaded
/// once more when that is done, and no volume held. Where a step cannot be loaded or rendered, all frames before it are
/// written, then its error is thrown; an error of `write` is thrown one frame later.
PlaybackReport play(Backend& backend, std::span<const std::string> files, const Scene& scene,
                    const RenderOptions& options, const SampleOptions& sampling, const FrameWriter& write);

}  // namespace weir
