#include "compressor/survey/visibility.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/sidecar/scene_opacity.h"

namespace weir {

Visibility::Visibility(const Scene& scene, const std::string& path, const Box& domain, Weighing weighing)
    : weighing_(weighing), region_(scene.volume.region.value_or(domain)) {
  const SceneVolume& volume = scene.volume;
  if (intersect(region_, domain).empty()) {
    throw Error(ErrorKind::usage, cat(path, ": [volume] region shows no voxel of the volume, whose index box is [[",
                                      domain.lo.x, ", ", domain.hi.x, "], [", domain.lo.y, ", ", domain.hi.y, "], [",
                                      domain.lo.z, ", ", domain.hi.z, "]]; give one inside it"));
  }
  if (scene.mode == RenderMode::iso && volume.iso) {
    by_iso_ = true;
    iso_ = static_cast<float>(*volume.iso);
    return;
  }
  if (scene.mode != RenderMode::iso && !volume.opacity.empty()) {
    if (!volume.range) {
      throw Error(ErrorKind::usage, cat(path,
                                        ": [volume] opacity needs range = [low, high] to say which values it "
                                        "hides; a file's own range changes with what is left out"));
    }
    low_ = (*volume.range)[0];
    high_ = (*volume.range)[1];
    const std::vector<float> table = opacity_table(volume.opacity);
    std::vector<float> steps(table.size());  // the first entry stays 0: no entry comes before it
    for (std::size_t i = 1; i < table.size(); ++i) steps[i] = std::fabs(table[i] - table[i - 1]);
    opacity_.emplace(table);
    steps_.emplace(std::move(steps));
    return;
  }
  if (!volume.region) {
    throw Error(ErrorKind::usage, compose(path, ": nothing in it says what can be seen; give [volume] ",
                                          scene.mode == RenderMode::iso ? "iso" : "opacity and range",
                                          ", or region, or leave out ", option("scene")));
  }
}

Visibility::Entries Visibility::entries_of(const MinMax& values) const {
  const auto last = static_cast<double>(opacity_->size() - 1);
  const auto position = [&](float value) {
    const double v = static_cast<double>(value);
    if (!(high_ > low_)) return v < low_ ? 0.0 : (v > low_ ? last : 0.5 * last);
    return std::clamp((v - low_) / (high_ - low_), 0.0, 1.0) * last;
  };
  return {static_cast<std::size_t>(std::floor(position(values.min))),
          static_cast<std::size_t>(std::ceil(position(values.max)))};
}

bool Visibility::shows(const MinMax& values) const {
  if (!(values.min <= values.max)) return false;
  if (by_iso_) return values.min <= iso_ && iso_ <= values.max;
  if (!opacity_) return true;
  const Entries e = entries_of(values);
  return opacity_->between(e.first, e.last) > 0;
}

double Visibility::weight(const MinMax& values) const {
  if (weighing_ == Weighing::alike || by_iso_ || !opacity_) return shows(values) ? 1 : 0;
  if (!(values.min <= values.max)) return 0;
  const Entries e = entries_of(values);
  if (e.first == e.last) return 0;  // beyond the range, or exactly one entry: opacity and colour do not change
  const auto steepest = static_cast<double>(steps_->between(e.first + 1, e.last));
  const auto highest = static_cast<double>(opacity_->between(e.first, e.last));
  const double slope = steepest * static_cast<double>(opacity_->size() - 1) + highest;
  return slope * slope;
}

}  // namespace weir
