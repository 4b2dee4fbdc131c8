// The conversion that keeps what a scene shows: `weir convert SOURCE --scene SCENE`, for people to read, or to be run.
#pragma once

#include <string>
#include <vector>

#include "format/sidecar/sidecar.h"
#include "tools/view/base/view_message.h"

namespace weir {

struct SceneConversion {
  std::vector<std::string> arguments;  ///< without the program; the last is the scene's path
  std::string output;                  ///< path
  std::string text;                    ///< the command for a shell, with the scene as "scene.toml", the last word
};

/// From `source`, of which `volume` is a preview, to "NAME_scene.nvdb" beside it; where `source` is empty, from the one
/// that `sidecar` names, a relative path as it leads from here or from the volume's directory, to a file beside the
/// volume. A name that is taken is numbered, NAME_scene_2.nvdb. The source is read as the sidecar says. Throws
/// Error(input) where it is not there, of another size or written to since, and where the volume is one level of
/// several.
SceneConversion scene_conversion(const std::string& volume, const std::string& source, const Sidecar& sidecar,
                                 const ConvertRequest& request);

/// The program's name and arguments, with the scene at that path.
std::vector<std::string> conversion_command(const SceneConversion& conversion, const std::string& scene);

}  // namespace weir
