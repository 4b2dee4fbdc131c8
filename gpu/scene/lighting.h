// The light that reaches a volume: a sky that depends on elevation or a picture of the surroundings, and a few
// directional lights. Radiance is linear RGB in units of a white of 1.
#pragma once

#include "gpu/scene/environment_view.h"

namespace weir {

inline constexpr int kMaxLights = 4;

/// Light from infinitely far away. `irradiance` is that of a surface facing it.
struct DirectionalLight {
  Float3 direction;  ///< unit, towards the light
  Float3 irradiance;
};

/// Radiance by elevation: ground below, horizon, zenith above, blended smoothly. If all three are equal, the light is
/// ambient. An environment replaces all three.
struct Lighting {
  Float3 up{0, 0, 1};
  Float3 zenith{1, 1, 1};
  Float3 horizon{1, 1, 1};
  Float3 ground{1, 1, 1};
  Float3 background;       ///< what the camera sees behind the volume
  bool sky_behind = true;  ///< true: the camera sees the sky instead of `background`
  DirectionalLight lights[kMaxLights];
  int light_count = 0;
  EnvironmentView environment;

  WEIR_HOST_DEVICE Float3 sky(const Float3& direction) const {
    if (environment.present()) return environment.at(direction);
    const float elevation = clamped(dot(direction, up), -1.0F, 1.0F);
    const Float3& end = elevation < 0.0F ? ground : zenith;
    return mix(horizon, end, std::sqrt(std::abs(elevation)));
  }

  WEIR_HOST_DEVICE Float3 behind(const Float3& direction) const {
    if (!sky_behind) return background;
    return environment.present() ? environment.blended(direction) : sky(direction);
  }

  /// Returns the light that a matt white surface of unit `normal` reflects, without shadows: the lights' by Lambert's
  /// law, plus the environment's mean over the hemisphere. Without an environment, the sky's value at the normal
  /// stands in for the mean.
  WEIR_HOST_DEVICE Float3 on_surface(const Float3& normal) const {
    Float3 sum = environment.present() ? environment.on_surface(normal) : sky(normal);
    for (int i = 0; i < light_count; ++i) {
      sum += lights[i].irradiance * (greater(dot(normal, lights[i].direction), 0.0F) / kPi);
    }
    return sum;
  }
};

}  // namespace weir
