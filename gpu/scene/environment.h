// The tables of an EnvironmentView on the host: radiance, what directions are
// drawn by, and the light on a surface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "format/sidecar/scene.h"
#include "gpu/image/image.h"
#include "gpu/scene/environment_view.h"

namespace weir {

/// Widest picture that is taken: 512 MiB of tables.
inline constexpr std::int32_t kMaxEnvironmentWidth = 8192;

/// How a picture is put around the scene.
struct EnvironmentPlacement {
  Double3 up{0, 0, 1};  ///< any length but 0
  double rotation = 0;  ///< degrees about `up`, counter-clockwise seen from above; 0: the centre at azimuth 0
  double scale = 1;     ///< factor on the radiance
};

class Environment {
 public:
  /// Throws Error(input) "NAME: ..." where the picture is not twice as wide as high, is too large, has negative,
  /// infinite or NaN values, or gives no light at all.
  Environment(const Image& image, const EnvironmentPlacement& placement, const std::string& name);

  /// Points into this object. Lengths of its arrays: see EnvironmentView.
  EnvironmentView view() const;

 private:
  void tabulate();
  void project();

  std::vector<Float3> radiance_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint32_t> columns_;
  EnvironmentView view_;
};

/// The environment of a scene's light; null where it names none. Errors of read_image and of the constructor; one of a
/// picture that cannot be opened or read says that the scene names it.
std::shared_ptr<const Environment> load_environment(const Scene& scene);

}  // namespace weir
