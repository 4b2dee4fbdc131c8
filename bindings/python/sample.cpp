// Grid::sample: filtered values at many positions.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "bindings/python/grid.h"
#include "gpu/volume/volume_sampler.h"

namespace weir::python {

namespace py = pybind11;

namespace {

/// Positions between which a thread may change; a look-up takes some 50 ns.
constexpr py::ssize_t kGrain = 4096;

}  // namespace

py::array_t<float> Grid::sample(const py::array_t<float, py::array::c_style>& points, bool trilinear) const {
  const auto file = shared();
  const py::ssize_t count = points.shape(0);
  py::array_t<float> array(count);
  const float* at = points.data();
  float* values = array.mutable_data();
  const py::gil_scoped_release unlocked;
  std::call_once(file->table_made, [&] { file->table.emplace(file->grid()); });
  const VolumeSampler volume{file->table->view(), trilinear ? Filter::trilinear : Filter::nearest};
  tbb::parallel_for(tbb::blocked_range<py::ssize_t>(0, count, kGrain),
                    [&](const tbb::blocked_range<py::ssize_t>& part) {
                      for (py::ssize_t i = part.begin(); i < part.end(); ++i) {
                        values[i] = volume.smooth({at[3 * i], at[3 * i + 1], at[3 * i + 2]});
                      }
                    });
  return array;
}

}  // namespace weir::python
