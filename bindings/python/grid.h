// An open NanoVDB file as Python sees it. Methods hold the interpreter's lock; the long ones release it. Returned
// arrays own their values.
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

/// x, y, z as a tuple, so that Python gets a tuple.
using Triple = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
using Position = std::tuple<double, double, double>;

class Grid {
 public:
  /// Maps and checks the file; reads no values. Throws as NvdbFile and open_source.
  explicit Grid(const std::string& path);
  /// Opens a packed file elsewhere. `fetch` is called with a list of (offset, bytes) and returns as many `bytes`
  /// objects, or raises; its exceptions reach the caller. `interrupt` makes running calls of `fetch` raise. `cache` is
  /// as for RemoteGrid, "256MiB". Throws as RemoteGrid, and Error(usage) if `cache` is not a size.
  Grid(const std::string& url, const pybind11::function& fetch, const pybind11::function& interrupt,
       const std::string& cache);

  /// Releases the file. Afterwards everything but closed() throws Error(usage); running calls of other threads end as
  /// if it were open.
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

  /// Returns the sidecar's JSON; nullopt if there is none. Throws Error(input) if the sidecar belongs to another file,
  /// and Error(usage) if the grid is remote.
  std::optional<std::string> sidecar() const;
  /// Checks and returns the sidecar `text`, read from `path`; also for a remote grid. Throws Error(input) if the text
  /// is not a valid sidecar or belongs to another file.
  std::string checked_sidecar(const std::string& text, const std::string& path) const;
  /// Returns float32 [z, y, x] of the box at a level: levels.h.
  pybind11::array_t<float> read(const Triple& lo, const Triple& hi, int level) const;
  /// Returns float32 [z, y, x] of `count` voxels along each axis, from `first` on in steps of `step`: strided_read.h.
  pybind11::array_t<float> read_strided(const Triple& first, const Triple& step, const Triple& count) const;
  /// Returns float32 values at `points` (N x 3: x, y, z in voxels from the lowest corner): volume_sampler.h.
  pybind11::array_t<float> sample(const pybind11::array_t<float, pybind11::array::c_style>& points,
                                  bool trilinear) const;
  /// Returns the voxels along a cell, the voxel position of the first cell's corner, and float32 [z, y, x] of minima
  /// and maxima.
  std::tuple<std::int64_t, Triple, pybind11::array_t<float>, pybind11::array_t<float>> macrocells() const;
  /// Returns the picture that `weir render` makes with `options`: uint8 sRGB or, if linear, float32 radiance, [y, x,
  /// RGB].
  pybind11::array render(const GivenOptions& options, bool linear, const pybind11::object& progress) const;
  /// Returns name, found, expected, ok of all checks of `weir verify`.
  std::vector<std::tuple<std::string, std::string, std::string, bool>> verify(const pybind11::object& progress) const;

 private:
  /// The data that calls share; the last call that uses it closes the file.
  struct Opened {
    std::shared_ptr<const NvdbFile> file;  ///< null if the grid is remote
    std::unique_ptr<RemoteGrid> remote;    ///< null if the grid is in a file
    std::unique_ptr<VolumeSource> source;
    std::function<void()> interrupt;  ///< ends the waits of a remote grid; otherwise empty
    std::once_flag samples_made;
    std::optional<GridSamples> samples;  ///< only of a file

    const NvdbGrid& grid() const { return file != nullptr ? file->grid() : remote->grid(); }
    /// Throws Error(input) if the file was written to or truncated since it was opened: its mapping may then have other
    /// values, or end the process. A file that was replaced by a rename is still intact. For a remote grid the reader
    /// detects changes. Makes one system call, which may wait for a server, so call it without the interpreter's lock.
    void require_unchanged() const;
    /// Throws Error(input) if `path` does not lead to the file that is open.
    void require_at(const std::string& path) const;
    /// Calls `use` while all that touches boxes(), in voxels from the lowest one, can be read from `source`. For a
    /// file, boxes() is not called.
    void with_boxes(const std::function<std::vector<Box>()>& boxes, const std::function<void()>& use) const;
    /// Calls `use` for one part after the other of `count` planes: with the planes [first, end) and their part of
    /// `values`, while all that touches boxes(first, end) can be read. A remote grid uses parts of `thickness` planes
    /// if all planes exceed its cache; otherwise there is a single part.
    void with_planes(std::span<float> values, std::int64_t count, std::int64_t thickness,
                     const std::function<std::vector<Box>(std::int64_t first, std::int64_t end)>& boxes,
                     const std::function<void(std::int64_t first, std::int64_t end, std::span<float> part)>& use) const;
  };

  Opened& opened() const;
  // Throws Error(input) if the sidecar, read from `path`, belongs to another file.
  std::string text_of(const Sidecar& sidecar, const std::string& path) const;
  // Throws Error(usage) if the grid is remote; `what` needs a file.
  std::shared_ptr<Opened> with_file(const char* what) const;
  std::shared_ptr<Opened> shared() const;

  std::string path_;      ///< as the caller gave it, for messages
  std::string absolute_;  ///< the file's absolute path, valid if the working directory changes; empty for a remote grid
  std::shared_ptr<Opened> file_;
};

}  // namespace weir::python
