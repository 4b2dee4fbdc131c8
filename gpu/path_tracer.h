// Volume path tracing: multiple scattering with delta tracking, directional
// lights by ratio tracking at every collision, the sky where a path escapes.
// The radiance is an unbiased estimate up to the bounce limit.
#pragma once

#include "gpu/lighting.h"
#include "gpu/phase.h"
#include "gpu/tracking.h"

namespace weir {

/// Collisions after which Russian roulette may end a path.
inline constexpr int kRouletteAfter = 4;

namespace detail {

// Light from all directional lights scattered at `position` towards where the path came from.
template <class Volume>
WEIR_HOST_DEVICE Float3 direct_light(const Medium<Volume>& medium, const Lighting& lighting, const Float3& position,
                                     const Float3& direction, Random& random) {
  Float3 sum;
  for (int i = 0; i < lighting.light_count; ++i) {
    const DirectionalLight& light = lighting.lights[i];
    Ray shadow = medium.ray(position, light.direction);
    const float length = enter(shadow, medium.shown);
    const float visible = ratio_track(medium, shadow, length, random);
    sum += light.irradiance * (visible * phase(dot(direction, light.direction), medium.g));
  }
  return sum;
}

}  // namespace detail

/// Radiance that arrives at `origin` (index space) from unit `direction` (physical space), at most
/// `max_bounces` collisions.
template <class Volume>
WEIR_HOST_DEVICE Float3 trace_path(const Medium<Volume>& medium, const Lighting& lighting, const Float3& origin,
                                   Float3 direction, int max_bounces, Random& random) {
  Float3 radiance;
  Float3 throughput{1, 1, 1};
  Ray ray = medium.ray(origin, direction);
  for (int bounce = 0;; ++bounce) {
    const float length = enter(ray, medium.shown);
    const Flight flight = length > 0.0F ? delta_track(medium, ray, length, random) : Flight{};
    if (flight.end == FlightEnd::absorbed) return radiance;
    if (flight.end == FlightEnd::escaped) {
      return radiance + throughput * (bounce == 0 ? lighting.behind(direction) : lighting.sky(direction));
    }
    const Float3 position = ray.at(flight.t);
    radiance += throughput * rgb(flight.colour) * medium.emission;
    throughput = throughput * rgb(flight.colour) * medium.albedo;
    if (bounce == max_bounces || !(max_component(throughput) > 0.0F)) return radiance;
    radiance += throughput * detail::direct_light(medium, lighting, position, direction, random);
    if (bounce >= kRouletteAfter) {
      const float survival = lesser(max_component(throughput), 1.0F);
      if (random.uniform() >= survival) return radiance;
      throughput = throughput * (1.0F / survival);
    }
    const float u = random.uniform();
    direction = sample_phase(direction, medium.g, u, random.uniform());
    ray = medium.ray(position, direction);
  }
}

}  // namespace weir
