// An open NanoVDB file as Python sees it. Methods hold the interpreter's lock; the long ones let go of it. Arrays that
// are handed out own their values.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "format/base/option_row.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/remote/remote_grid.h"
#include "format/sidecar/sidecar.h"
#include "gpu/volume/grid_samples.h"
#include "gpu/volume/volume_sampler.h"
#include "ingest/source/volume_source.h"

namespace weir::python {

/// x, y, z. A tuple: so is what Python gets.
using Triple = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
using Position = std::tuple<double, double, double>;

class Grid {
 public:
  /// Maps and checks the file; reads no values. Throws as NvdbFile and open_source.
  explicit Grid(const std::string& path);
  /// A packed file elsewhere: `fetch` is called with a list of (offset, bytes) and returns as many `bytes` objects, or
  /// raises; `interrupt` makes calls of it that are under way raise; `cache` as of RemoteGrid, "256MiB". What `fetch`
  /// raises goes on to whoever called. Throws as RemoteGrid, and Error(usage) where `cache` is no size.
  Grid(const std::string& url, const pybind11::function& fetch, const pybind11::function& interrupt,
       const std::string& cache);

  /// Lets go of the file. Everything but closed() throws Error(usage) from then on; calls of other threads that are
  /// under way end as if it were open.
  void close() { file_.reset(); }
  bool closed() const { return file_ == nullptr; }

  std::string type() const;
  bool packed() const;
  pybind11::str name() const;
  double background() const;
  std::tuple<double, double> range() const;  ///< smallest and largest active value, as the file says
  Triple extent() const;                     ///< voxels
  Triple index_origin() const;               ///< index of the lowest voxel
  Position spacing() const;
  Position origin() const;  ///< world position of index (0, 0, 0)
  std::uint64_t bytes() const;
  int levels() const;

  /// The sidecar's JSON; nullopt where there is none. Throws Error(input) where it is of another file, and Error(usage)
  /// where the grid lies elsewhere.
  std::optional<std::string> sidecar() const;
  /// The same of its text, read from `path`.
  std::string checked_sidecar(const std::string& text, const std::string& path) const;
  /// float32 [z, y, x] of the box at a level: levels.h.
  pybind11::array_t<float> read(const Triple& lo, const Triple& hi, int level) const;
  /// float32 [z, y, x] of `count` voxels along each axis, from `first` on in steps of `step`: strided_read.h.
  pybind11::array_t<float> read_strided(const Triple& first, const Triple& step, const Triple& count) const;
  /// float32 values at `points` (N x 3: x, y, z in voxels from the lowest corner): volume_sampler.h.
  pybind11::array_t<float> sample(const pybind11::array_t<float, pybind11::array::c_style>& points,
                                  bool trilinear) const;
  /// Voxels along a cell, voxel position of the first cell's corner, and float32 [z, y, x] of minima and maxima.
  std::tuple<std::int64_t, Triple, pybind11::array_t<float>, pybind11::array_t<float>> macrocells() const;
  /// The picture that `weir render` makes with `options`: uint8 sRGB or, where linear, float32 radiance, [y, x, RGB].
  pybind11::array render(const GivenOptions& options, bool linear, const pybind11::object& progress) const;
  /// name, found, expected, ok of all checks of `weir verify`.
  std::vector<std::tuple<std::string, std::string, std::string, bool>> verify(const pybind11::object& progress) const;

 private:
  /// What calls share; the last one of them closes the file.
  struct Opened {
    std::shared_ptr<const NvdbFile> file;  ///< null where it lies elsewhere
    std::unique_ptr<RemoteGrid> remote;    ///< else null
    std::unique_ptr<VolumeSource> source;
    std::function<void()> interrupt;  ///< ends what is waited for, of what lies elsewhere; else empty
    std::once_flag samples_made;
    std::optional<GridSamples> samples;  ///< of a file

    const NvdbGrid& grid() const { return file != nullptr ? file->grid() : remote->grid(); }
    /// Throws Error(input) where the file was written to or cut since it was opened: its mapping may have other values,
    /// or end the process. One that was replaced by a rename is as it was. Of what lies elsewhere the reader tells. One
    /// call of the system, which may wait for a server: without the interpreter's lock.
    void require_unchanged() const;
    /// Throws Error(input) where `path` does not lead to the file that is open.
    void require_at(const std::string& path) const;
    /// Calls `use` while what touches boxes(), in voxels from the lowest one, can be read from `source`; of a file
    /// nobody asks for them.
    void with_boxes(const std::function<std::vector<Box>()>& boxes, const std::function<void()>& use) const;
    /// Calls `use` with one part after the other of `count` planes, [first, end), and the part of `values` that is
    /// theirs, while what touches boxes(first, end) can be read: of a file elsewhere parts of `thickness` planes where
    /// all of them are more than its cache, else all.
    void with_planes(std::span<float> values, std::int64_t count, std::int64_t thickness,
                     const std::function<std::vector<Box>(std::int64_t first, std::int64_t end)>& boxes,
                     const std::function<void(std::int64_t first, std::int64_t end, std::span<float> part)>& use) const;
  };

  Opened& opened() const;
  // Throws Error(input) where the sidecar, read from `path`, is of another file.
  std::string text_of(const Sidecar& sidecar, const std::string& path) const;
  // Throws Error(usage) where the grid lies elsewhere; `what` needs a file.
  std::shared_ptr<Opened> with_file(const char* what) const;
  std::shared_ptr<Opened> shared() const;

  std::string path_;      ///< as it was given, for messages
  std::string absolute_;  ///< the file's, whatever the working directory is later; empty where it lies elsewhere
  std::shared_ptr<Opened> file_;
};

}  // namespace weir::python
