#include "bindings/python/grid.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "bindings/python/interpreter_end.h"
#include "bindings/python/levels.h"
#include "bindings/python/range_reader.h"
#include "bindings/python/remote_source.h"
#include "bindings/python/strided_read.h"
#include "bindings/python/watch.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_header.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/sidecar.h"
#include "gpu/volume/macrocell_grid.h"
#include "ingest/source_registry.h"
#include "tools/verify/volume_verification.h"

namespace weir::python {

namespace py = pybind11;

namespace {

Triple triple(const Index3& i) { return {i.x, i.y, i.z}; }
Index3 index3(const Triple& i) { return {std::get<0>(i), std::get<1>(i), std::get<2>(i)}; }

/// Returns an array [z, y, x].
py::array_t<float> make_array(const Index3& extent) { return py::array_t<float>({extent.z, extent.y, extent.x}); }

std::span<float> values_of(py::array_t<float>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

// Selects the first grid of a file of several grids, as everywhere in weir if no grid is named.
SourceOptions first_grid(const NvdbFile& file) {
  SourceOptions options;
  if (all_nvdb_segments(file.bytes(), file.path()).size() > 1) options.dataset = file.grid().name();
  return options;
}

// Returns an absolute path, so that it stays valid if the working directory changes.
std::string absolute_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path found = std::filesystem::absolute(path, error);
  return error ? path : found.string();
}

}  // namespace

Grid::Grid(const std::string& path) : path_(path), absolute_(absolute_path(path)), file_(std::make_shared<Opened>()) {
  without_lock([&] {
    file_->file = std::make_shared<const NvdbFile>(path);
    file_->source = open_source(path, first_grid(*file_->file));
  });
}

Grid::Grid(const std::string& url, const py::function& fetch, const py::function& interrupt, const std::string& cache)
    : path_(url), file_(std::make_shared<Opened>()) {
  const std::optional<std::uint64_t> bytes = parse_bytes(cache);
  if (!bytes) throw Error(ErrorKind::usage, cat("cache is '", cache, "', it must be a size as 67108864 or '256MiB'"));
  file_->interrupt = python_call(interrupt);
  const auto open = [&, reader = python_range_reader(fetch)](Watch&) {
    file_->remote = std::make_unique<RemoteGrid>(url, reader, *bytes);
    file_->source = std::make_unique<RemoteSource>(*file_->remote);
  };
  run_watched(py::none(), open, file_->interrupt);
}

namespace {

std::vector<Box> in_index_space(std::vector<Box> boxes, const NvdbGrid& grid) {
  const Index3 lo = grid.index_bbox().lo;
  for (Box& box : boxes) box = {lo + box.lo, lo + box.hi};
  return boxes;
}

}  // namespace

void Grid::Opened::require_unchanged() const {
  if (file == nullptr) return;
  try {
    file->mapping().check_unchanged();
  } catch (const Error&) {
    throw input_error(file->path(), "changed since it was opened; open it again");
  }
}

void Grid::Opened::require_at(const std::string& path) const {
  if (file->mapping().is_at(path)) return;
  throw input_error(file->path(), "was replaced or removed since it was opened; open it again");
}

void Grid::Opened::with_boxes(const std::function<std::vector<Box>()>& boxes, const std::function<void()>& use) const {
  if (remote == nullptr) return use();
  remote->with_blocks(in_index_space(boxes(), grid()), use);
}

void Grid::Opened::with_planes(
    std::span<float> values, std::int64_t count, std::int64_t thickness,
    const std::function<std::vector<Box>(std::int64_t first, std::int64_t end)>& boxes,
    const std::function<void(std::int64_t first, std::int64_t end, std::span<float> part)>& use) const {
  if (remote == nullptr) return use(0, count, values);
  if (remote->fit_cache(in_index_space(boxes(0, count), grid()))) thickness = count;
  for (std::int64_t first = 0; first < count; first += thickness) {
    const std::int64_t end = std::min(first + thickness, count);
    const std::size_t plane = values.size() / static_cast<std::size_t>(count);
    const auto part =
        values.subspan(static_cast<std::size_t>(first) * plane, static_cast<std::size_t>(end - first) * plane);
    with_boxes([&] { return boxes(first, end); }, [&] { use(first, end, part); });
  }
}

std::shared_ptr<Grid::Opened> Grid::with_file(const char* what) const {
  auto file = shared();
  if (file->file == nullptr) {
    throw Error(ErrorKind::usage, cat(path_, ": ", what, " reads all of the file; copy it to this machine"));
  }
  return file;
}

std::shared_ptr<Grid::Opened> Grid::shared() const {
  if (file_ == nullptr) throw Error(ErrorKind::usage, cat(path_, ": is closed; open it again with weir.open"));
  return file_;
}

Grid::Opened& Grid::opened() const { return *shared(); }

std::string Grid::type() const { return std::string(grid_type_name(opened().grid().type())); }
bool Grid::packed() const { return opened().grid().packed() != nullptr; }
py::str Grid::name() const {
  const std::string& name = opened().grid().name();
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(name.data(), static_cast<py::ssize_t>(name.size()), "replace"));
}
double Grid::background() const { return opened().grid().background(); }
std::tuple<double, double> Grid::range() const { return {opened().grid().value_min(), opened().grid().value_max()}; }
Triple Grid::extent() const { return triple(opened().grid().index_bbox().extent()); }
Triple Grid::index_origin() const { return triple(opened().grid().index_bbox().lo); }
Position Grid::spacing() const { return std::tuple_cat(opened().grid().voxel_size()); }
Position Grid::origin() const { return std::tuple_cat(opened().grid().world_origin()); }
std::uint64_t Grid::bytes() const {
  const Opened& file = opened();
  return file.file != nullptr ? file.file->bytes().size() : file.remote->bytes();
}
int Grid::levels() const { return level_count(opened().source->info().extent); }

std::optional<std::string> Grid::sidecar() const {
  const auto file = with_file("its sidecar");
  file->require_at(absolute_);
  const std::string path = find_sidecar(absolute_);
  if (!std::filesystem::exists(path)) return std::nullopt;
  return text_of(read_sidecar(path), path);
}

std::string Grid::checked_sidecar(const std::string& text, const std::string& path) const {
  return text_of(parse_sidecar(text, path), path);
}

std::string Grid::text_of(const Sidecar& sidecar, const std::string& path) const {
  const Opened& volume = opened();
  if (!(volume.file != nullptr ? is_of(sidecar, *volume.file) : is_of(sidecar, volume.grid()))) {
    throw Error(ErrorKind::input, cat(path, ": is of a file of ", sidecar.file.bytes, " bytes with another checksum, ",
                                      path_, " has ", bytes(), " bytes; convert it again"));
  }
  return to_json_text(sidecar);
}

py::array_t<float> Grid::read(const Triple& lo, const Triple& hi, int level) const {
  const auto file = shared();
  const Box box{index3(lo), index3(hi)};
  py::array_t<float> array = make_array(box.extent());
  const std::int64_t edge = std::int64_t{1} << level;
  const auto planes = [&](std::int64_t first, std::int64_t end) {
    return Box{{box.lo.x, box.lo.y, box.lo.z + first}, {box.hi.x, box.hi.y, box.lo.z + end}};
  };
  const auto voxels = [&](std::int64_t first, std::int64_t end) {
    const Box part = planes(first, end);
    return std::vector{Box{part.lo * edge, min(part.hi * edge, file->source->info().extent)}};
  };
  const auto read = [&, values = values_of(array)](Watch& watch) {
    file->require_unchanged();
    const auto use = [&](std::int64_t first, std::int64_t end, std::span<float> part) {
      read_level(*file->source, level, planes(first, end), part, watch.cancelled());
    };
    file->with_planes(values, box.extent().z, std::max<std::int64_t>(1, kLowerDim / edge), voxels, use);
  };
  run_watched(py::none(), read, file->interrupt);
  return array;
}

py::array_t<float> Grid::read_strided(const Triple& first, const Triple& step, const Triple& count) const {
  const auto file = shared();
  const Index3 from = index3(first);
  const Index3 by = index3(step);
  const Index3 number = index3(count);
  const std::array<Stride, 3> axes{{{from.x, by.x, number.x}, {from.y, by.y, number.y}, {from.z, by.z, number.z}}};
  py::array_t<float> array = make_array(number);
  const auto planes = [&](std::int64_t begin, std::int64_t end) {
    std::array<Stride, 3> part = axes;
    part[2] = {axes[2].at(begin), axes[2].step, end - begin};
    return part;
  };
  const auto read = [&, values = values_of(array)](Watch& watch) {
    file->require_unchanged();
    const auto use = [&](std::int64_t begin, std::int64_t end, std::span<float> part) {
      python::read_strided(*file->source, planes(begin, end), part, watch.cancelled());
    };
    file->with_planes(
        values, number.z, std::max<std::int64_t>(1, kLowerDim / std::abs(by.z)),
        [&](std::int64_t begin, std::int64_t end) { return strided_boxes(planes(begin, end), {}); }, use);
  };
  run_watched(py::none(), read, file->interrupt);
  return array;
}

std::tuple<std::int64_t, Triple, py::array_t<float>, py::array_t<float>> Grid::macrocells() const {
  const auto file = shared();
  std::optional<MacrocellGrid> cells;
  const auto gather = [&](Watch&) {
    file->require_unchanged();
    if (file->remote == nullptr) return void(cells.emplace(file->grid(), kMacrocell));
    if (!has_macrocells(file->grid())) {
      throw Error(ErrorKind::usage, cat(path_, ": has no macrocells; copy the file to this machine to gather them"));
    }
    file->remote->with_macrocells([&] { cells.emplace(file->grid(), kMacrocell); });
  };
  run_watched(py::none(), gather, file->interrupt);
  const CellLattice lattice = cells->lattice();
  const Index3 count{lattice.count.x, lattice.count.y, lattice.count.z};
  py::array_t<float> low = make_array(count);
  py::array_t<float> high = make_array(count);
  float* low_value = low.mutable_data();
  float* high_value = high.mutable_data();
  for (const MinMax& bounds : cells->bounds()) {
    *low_value++ = bounds.min;
    *high_value++ = bounds.max;
  }
  const Triple origin{-lattice.shift.x, -lattice.shift.y, -lattice.shift.z};
  return {static_cast<std::int64_t>(lattice.edge), origin, std::move(low), std::move(high)};
}

std::vector<std::tuple<std::string, std::string, std::string, bool>> Grid::verify(const py::object& progress) const {
  const auto file = with_file("verify");
  std::vector<std::tuple<std::string, std::string, std::string, bool>> all;
  run_watched(progress, [&](Watch& watch) {
    file->require_unchanged();
    file->require_at(absolute_);
    VerificationWatch verification;
    verification.pass_started = [&](const std::string& pass, std::uint64_t bytes) { watch.start(pass, bytes); };
    verification.pass_advanced = [&](std::uint64_t done) { watch.advance(done); };
    verification.cancel = &watch.cancelled();
    for (const VolumeCheck& check : verify_volume(absolute_, verification)) {
      all.emplace_back(check.name, check.found, check.expected, check.ok);
    }
  });
  return all;
}

}  // namespace weir::python
