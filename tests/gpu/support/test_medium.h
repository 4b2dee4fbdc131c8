// Media with light transport that is known in closed form: a volume given by a function of the position, cells of one
// size, and a transfer function of few points.
#pragma once

#include <utility>
#include <vector>

#include "gpu/math/random.h"
#include "gpu/trace/medium.h"

namespace weir::test {

/// A volume for the tracers. Its value at p is f(p).
template <class F>
struct FunctionVolume {
  Float3 size;
  F f;

  Float3 extent() const { return size; }
  float sample(const Float3& p, Random& /*random*/) const { return f(p); }
  float smooth(const Float3& p) const { return f(p); }
};

/// Owns the data that a Medium points to. For values in [0, 1], opacity and gray level are the value itself. Every
/// cell has the same majorant, and the bounds [0, majorant].
template <class F>
class TestMedium {
 public:
  TestMedium(Int3 voxels, std::int32_t cell, float density, float majorant, F f)
      : transfer_({{1, 1, 1, 0}, {1, 1, 1, 1}}, 0, 1),
        count_{(voxels.x + cell - 1) / cell, (voxels.y + cell - 1) / cell, (voxels.z + cell - 1) / cell},
        opacity_(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
                     static_cast<std::size_t>(count_.z),
                 majorant),
        bounds_(opacity_.size(), MinMax{0, majorant}),
        medium_{
            {.transfer = transfer_.view(),
             .cells = {count_, {0, 0, 0}, static_cast<float>(cell)},
             .shown = {{}, {static_cast<float>(voxels.x), static_cast<float>(voxels.y), static_cast<float>(voxels.z)}},
             .cell_opacity = opacity_.data(),
             .cell_values = bounds_.data(),
             .density = density},
            {{static_cast<float>(voxels.x), static_cast<float>(voxels.y), static_cast<float>(voxels.z)},
             std::move(f)}} {}
  TestMedium(const TestMedium&) = delete;
  TestMedium& operator=(const TestMedium&) = delete;

  Medium<FunctionVolume<F>>& operator*() { return medium_; }
  Medium<FunctionVolume<F>>* operator->() { return &medium_; }
  std::vector<float>& opacity() { return opacity_; }

 private:
  TransferFunction transfer_;
  Int3 count_;
  std::vector<float> opacity_;
  std::vector<MinMax> bounds_;
  Medium<FunctionVolume<F>> medium_;
};

/// The mean of a Monte-Carlo estimator and the mean's standard error.
struct Estimate {
  double mean = 0;
  double sigma = 0;
};

/// Calls `draw(Random&)` `count` times with independent streams.
template <class Draw>
Estimate estimate(std::uint32_t count, const Draw& draw) {
  double sum = 0;
  double squares = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    Random random(7, 11, i);
    const auto v = static_cast<double>(draw(random));
    sum += v;
    squares += v * v;
  }
  const double mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / count)};
}

}  // namespace weir::test
