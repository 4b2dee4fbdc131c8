#include "tools/view/refinement.h"

#include <algorithm>
#include <bit>

namespace weir {
namespace {

// The most samples per pixel of one pass. Requests that come in the meantime wait for its end.
constexpr std::uint32_t kMostOfPass = 4;

}  // namespace

std::uint32_t converged_samples(RenderMode mode) { return mode == RenderMode::path ? 256 : 16; }

Refinement::Refinement(std::int32_t width, std::int32_t height, int layers, double first, std::uint32_t samples)
    : width_(width),
      height_(height),
      share_(first),
      of_(samples),
      layers_(static_cast<std::size_t>(std::max(layers, 1))) {}

std::optional<RefinementPass> Refinement::next() const {
  if (samples_ >= of_) return std::nullopt;
  RefinementPass pass;
  if (share_ < 0.75) {
    pass.size = scaled(width_, height_, share_);
    pass.shown = true;
    return pass;
  }
  pass.whole = true;
  // A picture is sent when the samples reach a power of two: its noise variance is half that of the previous picture.
  const std::uint32_t until = std::min(of_, std::bit_ceil(samples_ + 1));
  pass.size = {width_, height_, std::min(until - samples_, kMostOfPass)};
  pass.seed = 1 + samples_;
  pass.shown = samples_ + pass.size.samples == until;
  return pass;
}

void Refinement::add(const RefinementPass& pass, const std::vector<Image>& layers) {
  unfinished_ = {};
  if (!pass.whole) {
    layers_ = layers;
    share_ *= 2;
    return;
  }
  share_ = 2;
  const auto weight = static_cast<float>(pass.size.samples);
  for (std::size_t l = 0; l < layers.size(); ++l) {
    if (samples_ == 0) layers_[l] = Image(width_, height_);
    for (std::size_t i = 0; i < layers[l].pixels.size(); ++i) layers_[l].pixels[i] += layers[l].pixels[i] * weight;
  }
  samples_ += pass.size.samples;
}

Image Refinement::picture() const {
  Image all = stacked(layers_);
  if (samples_ == 0) return all;
  const float scale = 1.0F / static_cast<float>(samples_);
  for (Float3& pixel : all.pixels) pixel = pixel * scale;
  return all;
}

Image stacked(const std::vector<Image>& layers) {
  Image all;
  for (const Image& layer : layers) {
    all.width = layer.width;
    all.height += layer.height;
    all.pixels.insert(all.pixels.end(), layer.pixels.begin(), layer.pixels.end());
  }
  return all;
}

}  // namespace weir
