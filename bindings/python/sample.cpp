// Grid::sample(): filtered values at many positions.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "bindings/python/grid.h"
#include "bindings/python/interpreter_end.h"
#include "bindings/python/sampled_blocks.h"
#include "bindings/python/watch.h"
#include "compressor/plan/own_threads.h"
#include "gpu/volume/volume_sampler.h"

namespace weir::python {

namespace py = pybind11;

namespace {

/// Positions per task of a thread; a look-up takes some 50 ns.
constexpr std::size_t kGrain = 4096;

// `positions` holds x, y, z of one position after the other.
template <class Volume>
void sample_part(const Volume& volume, std::span<const float> positions, const tbb::blocked_range<std::size_t>& part,
                 float* values) {
  for (std::size_t i = part.begin(); i < part.end(); ++i) {
    const float* const at = &positions[3 * i];
    values[i] = volume.value({at[0], at[1], at[2]});
  }
}

}  // namespace

py::array_t<float> Grid::sample(const py::array_t<float, py::array::c_style>& points, bool trilinear) const {
  const auto file = shared();
  const Filter filter = trilinear ? Filter::trilinear : Filter::nearest;
  const std::span<const float> positions(points.data(), static_cast<std::size_t>(points.size()));
  py::array_t<float> array(points.shape(0));
  float* const values = array.mutable_data();
  if (file->remote != nullptr) {
    const auto look_up = [&](Watch& watch) {
      const NvdbGrid& grid = file->grid();
      file->with_boxes([&] { return sampled_blocks(positions, grid.index_bbox()); },
                       [&] {
                         for (std::span<const float> left = positions; !left.empty();) {
                           watch.stop_if_cancelled();
                           const std::span<const float> part = left.first(std::min(3 * kGrain, left.size()));
                           const DecodedBlocks blocks(grid, sampled_blocks(part, grid.index_bbox()));
                           sample_part(FilteredVolume<DecodedBlocks>{blocks, filter}, part, {0, part.size() / 3},
                                       values + (positions.size() - left.size()) / 3);
                           left = left.subspan(part.size());
                         }
                       });
    };
    run_watched(py::none(), look_up, file->interrupt);
    return array;
  }
  without_lock([&] {
    file->require_unchanged();
    OwnArena().run([&] {
      std::call_once(file->samples_made, [&] { file->samples.emplace(file->grid()); });
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positions.size() / 3, kGrain), [&](const auto& part) {
        file->samples->with_volume(filter, [&](const auto& volume) { sample_part(volume, positions, part, values); });
      });
    });
  });
  return array;
}

}  // namespace weir::python
