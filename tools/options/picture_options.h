// The options that say how a picture looks, the same for every command that renders.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "format/base/option_row.h"
#include "format/sidecar/scene.h"
#include "gpu/render/backend.h"
#include "tools/options/backend_choice.h"

namespace CLI {
class App;
}

namespace weir {

/// Adds --scene, --mode, --backend, --devices, --size, --spp, --seed, --filter, --colormap, --colorbar, --range,
/// --iso, --camera, --threads, --memory and the other picture options. Their text is stored in `given`, which must
/// live as long as the command.
void add_picture_options(CLI::App& command, GivenOptions& given);

/// Adds only --backend, --devices, --threads, --memory and --device-memory.
void add_backend_options(CLI::App& command, GivenOptions& given);

/// Returns the back end that the options of add_backend_options() choose. Throws Error(usage) as read_picture_request.
BackendChoice read_backend_choice(const GivenOptions& given);

/// The parsed values of all picture options.
struct PictureRequest {
  Scene scene;
  RenderOptions options;  ///< includes the scene's environment, loaded
  SampleOptions sampling;
  BackendChoice backend{"auto", {0}, 0};
  bool colorbar = false;  ///< draws a colour bar beside the picture: tools/plot/color_bar.h

  std::uint64_t pixel_samples() const {
    return static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height) * sampling.samples;
  }
};

/// Returns "trilinear", "stochastic" or "nearest", as --filter spells it.
std::string filter_name(Filter filter);

/// Reads the scene file, then applies the other options over it. Throws Error(usage), naming option, text and expected
/// form, if an option cannot be read; also throws as load_scene and load_environment.
PictureRequest read_picture_request(const GivenOptions& options);

/// Returns the files that a picture needs besides its volume: the scene, and the environment that the scene names.
std::vector<std::string> picture_inputs(const GivenOptions& given, const PictureRequest& request);

}  // namespace weir
