#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "bindings/c/open_grid.h"
#include "bindings/c/status.h"
#include "bindings/c/versioned_struct.h"
#include "bindings/c/weir.h"
#include "format/nanovdb/read_box.h"
#include "gpu/volume/volume_sampler.h"
#include "ingest/source/extent.h"

namespace weir::c {
namespace {

std::int32_t encoding_of(const NvdbGrid& grid) {
  if (grid.packed() != nullptr) return WEIR_ENCODING_PACKED;
  switch (grid.type()) {
    case GridType::float32:
      return WEIR_ENCODING_FLOAT;
    case GridType::fp4:
      return WEIR_ENCODING_FP4;
    case GridType::fp8:
      return WEIR_ENCODING_FP8;
    case GridType::fp16:
      return WEIR_ENCODING_FP16;
    case GridType::fpn:
      return WEIR_ENCODING_FPN;
  }
  throw Error(ErrorKind::internal, "unknown grid type");
}

void put(const Index3& index, std::int64_t (&triple)[3]) {
  triple[0] = index.x;
  triple[1] = index.y;
  triple[2] = index.z;
}

void certify(const Sidecar& sidecar, weir_grid_info& info) {
  info.certified = 1;
  info.lossless = sidecar.error.lossless ? 1 : 0;
  info.psnr_db = sidecar.error.psnr_db.value_or(std::numeric_limits<double>::infinity());
  info.mse = sidecar.error.mse;
  info.max_abs_error = sidecar.error.max_abs;
  std::copy(sidecar.value_range.begin(), sidecar.value_range.end(), info.source_range);
  info.nonfinite = sidecar.nonfinite.count;
  info.missing = sidecar.missing.count;
}

weir_grid_info describe(const weir_grid& handle) {
  const NvdbGrid& grid = handle.grid();
  weir_grid_info info{};
  put(grid.index_bbox().extent(), info.extent);
  put(grid.index_bbox().lo, info.index_min);
  const auto spacing = grid.voxel_size();
  const auto origin = grid.world_origin();
  std::copy(spacing.begin(), spacing.end(), info.spacing);
  std::copy(origin.begin(), origin.end(), info.origin);
  info.range[0] = static_cast<double>(grid.value_min());
  info.range[1] = static_cast<double>(grid.value_max());
  info.background = static_cast<double>(grid.background());
  info.file_bytes = grid.bytes().size();
  info.grid_offset = grid.grid_offset();
  info.grid_bytes = grid.grid_bytes();
  info.data_bytes = grid.data_bytes();
  info.encoding = encoding_of(grid);
  if (handle.sidecar() != nullptr) certify(*handle.sidecar(), info);
  return info;
}

/// Throws Error(usage) if a corner is beyond the 32 bits of NanoVDB's coordinates, or if `count` is not the number of
/// voxels.
Box checked_box(const std::int64_t* min, const std::int64_t* max, std::size_t count) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 31U;
  const Box box{{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
  for (std::size_t a = 0; a < 3; ++a) {
    if (min[a] < -kLimit || max[a] > kLimit || min[a] >= max[a]) {
      throw usage(cat("the box is ", box_text(box), "; it must hold a voxel along each axis, from -2^31 to 2^31"));
    }
  }
  const Index3 e = box.extent();
  std::int64_t plane = 0;
  std::int64_t voxels = 0;
  if (__builtin_mul_overflow(e.x, e.y, &plane) || __builtin_mul_overflow(plane, e.z, &voxels) ||
      std::cmp_not_equal(voxels, count)) {
    throw usage(cat("count is ", count, ", and the box ", box_text(box), " has ", extent_text(e), " voxels"));
  }
  return box;
}

}  // namespace
}  // namespace weir::c

using namespace weir;
using namespace weir::c;

const char* weir_version(void) { return WEIR_VERSION; }

weir_status weir_open(const char* path, weir_grid** grid, weir_error* error) {
  return guarded(error, [&] {
    required(grid, "grid");
    *grid = new weir_grid(std::string(required_path(path, "path")));
  });
}

weir_status weir_open_memory(const void* data, uint64_t bytes, const char* sidecar, weir_grid** grid,
                             weir_error* error) {
  return guarded(error, [&] {
    required(grid, "grid");
    *grid = new weir_grid({static_cast<const std::byte*>(required(data, "data")), bytes}, sidecar);
  });
}

void weir_close(weir_grid* grid) { delete grid; }

weir_status weir_grid_info_init(weir_grid_info* info, size_t struct_size) { return init_struct(info, struct_size); }

weir_status weir_get_info(const weir_grid* grid, weir_grid_info* info, weir_error* error) {
  return guarded(error, [&] {
    required(grid, "grid");
    read_struct(info, "weir_grid_info");
    write_struct(describe(*grid), info);
  });
}

const char* weir_grid_name(const weir_grid* grid) { return grid == nullptr ? nullptr : grid->grid().name().c_str(); }
const char* weir_grid_sidecar(const weir_grid* grid) { return grid == nullptr ? nullptr : grid->sidecar_text(); }
const void* weir_grid_data(const weir_grid* grid) { return grid == nullptr ? nullptr : grid->grid().data().data(); }

weir_status weir_value(const weir_grid* grid, const int64_t index[3], float* value, weir_error* error) {
  return guarded(error, [&] {
    required(index, "index");
    *required(value, "value") = required(grid, "grid")->grid().value({index[0], index[1], index[2]});
  });
}

weir_status weir_read_box(const weir_grid* grid, const int64_t min[3], const int64_t max[3], float* values,
                          size_t count, weir_error* error) {
  return guarded(error, [&] {
    required(grid, "grid");
    const Box box = checked_box(required(min, "min"), required(max, "max"), count);
    read_box(grid->grid(), box, {required(values, "values"), count});
  });
}

weir_status weir_sample(const weir_grid* grid, int32_t filter, const float* positions, size_t count, float* values,
                        weir_error* error) {
  return guarded(error, [&] {
    required(grid, "grid");
    if (filter != WEIR_FILTER_NEAREST && filter != WEIR_FILTER_TRILINEAR) {
      throw usage(cat("filter is ", filter, ", it must be WEIR_FILTER_NEAREST or _TRILINEAR"));
    }
    if (count == 0) return;
    required(positions, "positions");
    required(values, "values");
    grid->samples().with_volume(filter == WEIR_FILTER_NEAREST ? Filter::nearest : Filter::trilinear,
                                [&](const auto& volume) {
                                  for (std::size_t i = 0; i < count; ++i) {
                                    const Float3 at{positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
                                    const bool nowhere = std::isnan(at.x) || std::isnan(at.y) || std::isnan(at.z);
                                    values[i] = nowhere ? std::numeric_limits<float>::quiet_NaN() : volume.value(at);
                                  }
                                });
  });
}
