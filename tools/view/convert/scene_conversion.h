// The conversion that keeps what a scene shows: `weir convert SOURCE --scene SCENE`, to be shown or to be run.
#pragma once

#include <string>
#include <vector>

#include "format/sidecar/sidecar.h"
#include "tools/view/base/view_message.h"

namespace weir {

struct SceneConversion {
  std::vector<std::string> arguments;  ///< without the program; the last argument is the scene's path
  std::string output;                  ///< path
  std::string text;                    ///< the command for a shell; its last word is "scene.toml" for the scene
};

/// Returns the conversion for a scene. If `volume` is a preview of `source`, converts `source` to "NAME_scene.nvdb"
/// beside the source. If `source` is empty, converts the source that `sidecar` names (a relative path starts here or
/// in the volume's directory) to a file beside the volume. A taken name is numbered, NAME_scene_2.nvdb. The source is
/// read as the sidecar says. Throws Error(input) if the source is missing, has another size or was written to since,
/// or if the volume is one level of several.
SceneConversion scene_conversion(const std::string& volume, const std::string& source, const Sidecar& sidecar,
                                 const ConvertRequest& request);

/// Returns the program's name and arguments, with `scene` as the scene's path.
std::vector<std::string> conversion_command(const SceneConversion& conversion, const std::string& scene);

}  // namespace weir
