// What a picture looks like, as options: the same for every command that renders.
#pragma once

#include <memory>
#include <string>

#include "format/sidecar/scene.h"
#include "gpu/render/backend.h"
#include "tools/options/backend_choice.h"

namespace CLI {
class App;
}

namespace weir {

/// The options as given; empty: not given.
struct PictureArguments {
  std::string scene;
  std::string mode;
  std::string backend = "auto";
  std::string devices = "0";
  std::string filter = "trilinear";
  std::string size = "960x720";
  std::string colormap;
  std::string camera;
  std::string iso;
  std::string range;
  std::string samples;
  std::string seed = "0";
  std::string threads = "0";
};

/// Adds --backend, --devices, --mode, --size, --spp, --seed, --scene, --filter, --colormap, --range, --iso, --camera
/// and
/// --threads, stored in `arguments`, which must live as long as the command.
void add_picture_options(CLI::App& command, PictureArguments& arguments);

/// What they mean.
struct PictureRequest {
  Scene scene;
  RenderOptions options;  ///< with the scene's environment, loaded
  SampleOptions sampling;
  BackendChoice backend;

  std::uint64_t pixel_samples() const {
    return static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height) * sampling.samples;
  }
};

/// The scene file first, the command line over it. Throws Error(usage) naming option, text and form where one cannot be
/// read, and as load_scene and load_environment.
PictureRequest parse_picture(const PictureArguments& arguments);

}  // namespace weir
