// The tables of an EnvironmentView on the host: radiance, probabilities for drawing directions, and the light on a
// surface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "format/sidecar/scene.h"
#include "gpu/image/image.h"
#include "gpu/scene/environment_view.h"

namespace weir {

/// Widest accepted picture: 512 MiB of tables.
inline constexpr std::int32_t kMaxEnvironmentWidth = 8192;

/// How a picture is placed around the scene.
struct EnvironmentPlacement {
  Double3 up{0, 0, 1};  ///< any length except 0
  double rotation = 0;  ///< degrees about `up`, counter-clockwise seen from above; 0: the picture's centre is at
                        ///< azimuth 0
  double scale = 1;     ///< factor on the radiance
};

class Environment {
 public:
  /// Throws Error(input) "NAME: ..." if the picture is not twice as wide as high, is too large, has negative,
  /// infinite or NaN values, or gives no light at all.
  Environment(const Image& image, const EnvironmentPlacement& placement, const std::string& name);

  /// Returns a view that points into this object. EnvironmentView gives the lengths of its arrays.
  EnvironmentView view() const;

 private:
  void tabulate();
  void project();

  std::vector<Float3> radiance_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint32_t> columns_;
  EnvironmentView view_;
};

/// Returns the environment of a scene's light; null if the scene names none. Throws the errors of read_image and of
/// the constructor. If a picture cannot be opened or read, the error says that the scene names it.
std::shared_ptr<const Environment> load_environment(const Scene& scene);

}  // namespace weir
