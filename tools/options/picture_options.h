// What a picture looks like, as options: the same for every command that renders.
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
/// --iso, --camera, --threads and --memory; what is given goes to `given`, which must live as long as the command.
void add_picture_options(CLI::App& command, GivenOptions& given);

/// Of these, --backend, --devices, --threads, --memory and --device-memory alone.
void add_backend_options(CLI::App& command, GivenOptions& given);

/// What those mean. Throws Error(usage) as read_picture_request.
BackendChoice read_backend_choice(const GivenOptions& given);

/// What all of them mean.
struct PictureRequest {
  Scene scene;
  RenderOptions options;  ///< with the scene's environment, loaded
  SampleOptions sampling;
  BackendChoice backend{"auto", {0}, 0};
  bool colorbar = false;  ///< beside the picture: tools/plot/color_bar.h

  std::uint64_t pixel_samples() const {
    return static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height) * sampling.samples;
  }
};

/// "trilinear", "stochastic" or "nearest", as --filter says it.
std::string filter_name(Filter filter);

/// The scene file first, the command line over it. Throws Error(usage) naming option, text and form where one cannot be
/// read, and as load_scene and load_environment.
PictureRequest read_picture_request(const GivenOptions& options);

/// The files that a picture is made from besides its volume: a scene, and the environment that this names.
std::vector<std::string> picture_inputs(const GivenOptions& given, const PictureRequest& request);

}  // namespace weir
