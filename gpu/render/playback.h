// Renders a series of volumes as frames. While one step renders, one thread loads the next step and another writes
// the frame before. At most two volumes are held at a time.
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
  double load_s = 0;   ///< working time of this stage; the stages overlap
  double render_s = 0;
  double write_s = 0;
  double sustained = 0;  ///< frames per second from the first frame written to the last; over the whole time if there
                         ///< is only one frame
  LoadSummary load;      ///< how the last step was loaded

  /// Returns "load", "render" or "write": the stage that worked longest, so that the others wait for it.
  std::string_view limit() const;
};

/// Called with ascending frame numbers, from a separate thread, one call at a time.
using FrameWriter = std::function<void(std::size_t frame, const Picture& picture)>;

/// Renders one frame of each of `files`, in order. If `options` has no density_frame, the first step's frame is used.
/// If a step fails to load with an Error of kind io while another volume is held (for lack of device memory, for
/// example), it is loaded once more after that volume has been rendered and freed. If a step cannot be loaded or
/// rendered, all frames before it are written before its error is thrown. An error of `write` is thrown one frame
/// later.
PlaybackReport play(Backend& backend, std::span<const std::string> files, const Scene& scene,
                    const RenderOptions& options, const SampleOptions& sampling, const FrameWriter& write);

}  // namespace weir
