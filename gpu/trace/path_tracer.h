// Volume path tracing: multiple scattering with delta tracking, directional lights by ratio tracking at every
// collision, and the sky for a path that escapes. An environment is sampled in both ways: by directions drawn towards
// its light, and by the directions that scattering draws. Both are weighted by the balance heuristic (Veach and
// Guibas, Optimally Combining Sampling Techniques, SIGGRAPH 1995). The radiance is an unbiased estimate up to the
// bounce limit.
#pragma once

#include "gpu/scene/lighting.h"
#include "gpu/trace/phase.h"
#include "gpu/trace/tracking.h"

namespace weir {

/// Number of collisions after which Russian roulette may end a path.
inline constexpr int kRouletteAfter = 4;

namespace detail {

// Returns the light that is scattered at `position` towards where the path came from. It comes from all directional
// lights and from one direction of the environment. One loop, so that a device holds one copy of the tracking code.
template <class Volume>
WEIR_HOST_DEVICE Float3 direct_light(const Medium<Volume>& medium, const Lighting& lighting, const Float3& position,
                                     const Float3& direction, Random& random) {
  Float3 sum;
  const int count = lighting.light_count + (lighting.environment.present() ? 1 : 0);
  for (int i = 0; i < count; ++i) {
    Float3 towards;
    Float3 light;
    float scattered = 0;
    if (i < lighting.light_count) {
      towards = lighting.lights[i].direction;
      light = lighting.lights[i].irradiance;
      scattered = phase(dot(direction, towards), medium.g);
    } else {
      const EnvironmentSample drawn = lighting.environment.sample(random);
      towards = drawn.direction;
      light = drawn.radiance;
      // phase / density, times the balance heuristic's weight density / (density + phase)
      const float turned = phase(dot(direction, towards), medium.g);
      scattered = turned / (drawn.density + turned);
    }
    Ray shadow = medium.ray(position, towards);
    const float length = enter(shadow, medium.shown);
    const float visible = ratio_track(medium, shadow, length, RayKind::scattered, random);
    sum += light * (visible * scattered);
  }
  return sum;
}

}  // namespace detail

/// Returns the radiance that arrives at `origin` (index space) from unit `direction` (physical space), after at most
/// `max_bounces` scatterings. The collision after the last scattering emits but does not scatter.
template <class Volume>
WEIR_HOST_DEVICE Float3 trace_path(const Medium<Volume>& medium, const Lighting& lighting, const Float3& origin,
                                   Float3 direction, int max_bounces, Random& random) {
  Float3 radiance;
  Float3 throughput{1, 1, 1};
  Ray ray = medium.ray(origin, direction);
  float turned = 0;  // with an environment: the density with which the phase function drew `direction`
  for (int bounce = 0;; ++bounce) {
    const float length = enter(ray, medium.shown);
    const RayKind kind = bounce == 0 ? RayKind::camera : RayKind::scattered;
    const Flight flight = length > 0.0F ? delta_track(medium, ray, length, kind, random) : Flight{};
    if (flight.end == FlightEnd::absorbed) return radiance;
    if (flight.end == FlightEnd::escaped) {
      if (bounce == 0) return radiance + throughput * lighting.behind(direction);
      float weight = 1.0F;
      if (lighting.environment.present()) weight = turned / (turned + lighting.environment.density(direction));
      return radiance + throughput * lighting.sky(direction) * weight;
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
    const Float3 before = direction;
    direction = sample_phase(before, medium.g, u, random.uniform());
    if (lighting.environment.present()) turned = phase(dot(before, direction), medium.g);
    ray = medium.ray(position, direction);
  }
}

}  // namespace weir
