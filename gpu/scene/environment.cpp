#include "gpu/scene/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/image/image_input.h"
#include "gpu/scene/scene_camera.h"

namespace weir {

namespace {

void check_size(std::int32_t width, std::int32_t height, const std::string& name) {
  if (height < 1 || width != 2 * std::int64_t{height}) {
    throw Error(ErrorKind::input, cat(name, ": ", width, " x ", height,
                                      " pixels; a latitude-longitude picture is twice as wide as high"));
  }
  if (width > kMaxEnvironmentWidth) {
    throw Error(ErrorKind::input, cat(name, ": ", width, " x ", height, " pixels; scale it down to at most ",
                                      kMaxEnvironmentWidth, " x ", kMaxEnvironmentWidth / 2));
  }
}

void check_pixels(const Image& image, const std::string& name) {
  const auto bad = [](const Float3& p) {
    return !is_finite(p.x) || !is_finite(p.y) || !is_finite(p.z) || p.x < 0.0F || p.y < 0.0F || p.z < 0.0F;
  };
  const auto first = std::find_if(image.pixels.begin(), image.pixels.end(), bad);
  if (first == image.pixels.end()) return;
  const auto at = first - image.pixels.begin();
  throw Error(ErrorKind::input,
              cat(name, ": pixel (", at % image.width, ", ", at / image.width, ") is (", first->x, ", ", first->y, ", ",
                  first->z, "), and there are ", std::count_if(image.pixels.begin(), image.pixels.end(), bad),
                  " such; radiance must be finite and not negative"));
}

// The command line does not name this file. If it cannot be opened, the error must say that the scene names it.
Image read_picture(const std::string& path) {
  try {
    return read_image(path, [&](std::int32_t width, std::int32_t height) { check_size(width, height, path); });
  } catch (const Error& error) {
    if (!error.system_failure()) throw;
    throw Error(error.kind(), compose(error.message(), "; the scene's [lighting] environment names it"),
                error.system_failure());
  }
}

// Returns the luminance by Rec. 709 of a linear colour.
double luminance(const Float3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// Fills bounds in proportion to `weights`, from 0 to kEnvironmentUnit. If all weights are 0, the bounds are
// arbitrary.
void fill_bounds(const std::vector<double>& weights, std::uint32_t* bounds) {
  double total = 0;
  for (const double w : weights) total += w;
  const auto bound = [&](double share) { return static_cast<std::uint32_t>(std::llround(share * kEnvironmentUnit)); };
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    bounds[i] = total > 0 ? std::min(bound(sum / total), kEnvironmentUnit) : 0;
    sum += weights[i];
  }
  bounds[weights.size()] = kEnvironmentUnit;
  // What rounding leaves after the last weight above 0 belongs to that weight.
  for (std::size_t i = weights.size(); i-- > 0 && total > 0 && !(weights[i] > 0);) bounds[i] = kEnvironmentUnit;
}

}  // namespace

Environment::Environment(const Image& image, const EnvironmentPlacement& placement, const std::string& name)
    : radiance_(image.pixels) {
  check_size(image.width, image.height, name);
  check_pixels(image, name);
  const auto scale = static_cast<float>(placement.scale);
  for (Float3& texel : radiance_) {
    const Float3 scaled = texel * scale;
    texel = {lesser(scaled.x, 1e30F), lesser(scaled.y, 1e30F), lesser(scaled.z, 1e30F)};  // keeps sums finite
  }
  view_.radiance = radiance_.data();
  view_.width = image.width;
  view_.height = image.height;
  const AzimuthFrame frame = azimuth_frame(placement.up, placement.rotation);
  view_.up = frame.up;
  view_.ahead = frame.ahead;
  view_.left = frame.left;
  const auto dark = [](const Float3& c) { return !(luminance(c) > 0); };
  if (std::all_of(radiance_.begin(), radiance_.end(), dark)) {
    throw Error(ErrorKind::input, cat(name, ": the picture is black, at environment_scale ", placement.scale,
                                      "; an environment must give light"));
  }
  tabulate();
  project();
}

EnvironmentView Environment::view() const { return view_; }

void Environment::tabulate() {
  const auto width = static_cast<std::size_t>(view_.width);
  const auto height = static_cast<std::size_t>(view_.height);
  rows_.resize(height + 1);
  columns_.resize(height * (width + 1));
  std::vector<double> row_weights(height);
  std::vector<double> weights(width);
  for (std::size_t row = 0; row < height; ++row) {
    double sum = 0;
    for (std::size_t column = 0; column < width; ++column) {
      weights[column] = luminance(radiance_[row * width + column]);
      sum += weights[column];
    }
    row_weights[row] = sum * static_cast<double>(view_.solid_angle(static_cast<std::int32_t>(row)));
    fill_bounds(weights, columns_.data() + row * (width + 1));
  }
  fill_bounds(row_weights, rows_.data());
  view_.rows = rows_.data();
  view_.columns = columns_.data();
}

// Projects the radiance to spherical harmonics up to degree 2, multiplied by the cosine lobe's (pi, 2 pi / 3, pi / 4)
// / pi.
void Environment::project() {
  constexpr std::size_t kTerms = 9;
  std::array<Double3, kTerms> sums{};
  for (std::int32_t row = 0; row < view_.height; ++row) {
    const double polar = (row + 0.5) * std::numbers::pi / view_.height;
    const double steradians = static_cast<double>(view_.solid_angle(row));
    for (std::int32_t column = 0; column < view_.width; ++column) {
      const double azimuth = std::numbers::pi - (column + 0.5) * 2 * std::numbers::pi / view_.width;
      const double x = std::sin(polar) * std::cos(azimuth);
      const double y = std::sin(polar) * std::sin(azimuth);
      const double z = std::cos(polar);
      const std::array<double, kTerms> basis{1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y};
      const Float3& c = radiance_[static_cast<std::size_t>(view_.index(row, column))];
      for (std::size_t k = 0; k < kTerms; ++k) {
        sums[k][0] += steradians * basis[k] * static_cast<double>(c.x);
        sums[k][1] += steradians * basis[k] * static_cast<double>(c.y);
        sums[k][2] += steradians * basis[k] * static_cast<double>(c.z);
      }
    }
  }
  // Squares of the basis functions' norms: 1 / 4 pi; 3 / 4 pi; 15 / 4 pi, 5 / 16 pi and 15 / 16 pi.
  constexpr double kNorm = 1 / (4 * std::numbers::pi);
  constexpr double kLinear = 3 * kNorm * 2 / 3;
  constexpr double kProduct = 15 * kNorm / 4;
  constexpr std::array<double, kTerms> kFactors{kNorm,    kLinear,        kLinear,  kLinear,     kProduct,
                                                kProduct, kNorm * 5 / 16, kProduct, kProduct / 4};
  for (std::size_t k = 0; k < kTerms; ++k) {
    const auto factor = [&](std::size_t channel) { return static_cast<float>(sums[k][channel] * kFactors[k]); };
    view_.harmonics[k] = {factor(0), factor(1), factor(2)};
  }
}

std::shared_ptr<const Environment> load_environment(const Scene& scene) {
  const std::string& path = scene.lighting.environment;
  if (path.empty()) return nullptr;
  const Image image = read_picture(path);
  return std::make_shared<const Environment>(image,
                                             EnvironmentPlacement{.up = scene.camera.up,
                                                                  .rotation = scene.lighting.environment_rotation,
                                                                  .scale = scene.lighting.environment_scale},
                                             path);
}

}  // namespace weir
