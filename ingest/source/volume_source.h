// Sources of volumes. One implementation per file format; all of them hand out boxes of float32 values, x fastest, and
// never hold more than they were handed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "format/layout/nvdb_type.h"
#include "ingest/files/file_state.h"
#include "ingest/source/field_details.h"
#include "ingest/source/repeated_part.h"
#include "ingest/source/stored_value.h"

namespace weir {

class CellPlaces;
class HeldLeaves;
class ResidentVolume;

/// What a source knows about its volume without reading it.
struct SourceInfo {
  std::string path;
  std::string format;                      ///< "raw", "synthetic", ...
  std::string dataset;                     ///< name inside a container, else empty
  std::vector<std::int64_t> index;         ///< position on the leading axes of an array of more than three
  std::array<std::string, 3> axis_labels;  ///< of x, y, z, x fastest in memory; empty where the file names none
  std::string units;                       ///< of the values as the file says it, "kg m-3"; else empty
  std::optional<double> unit_si;           ///< openPMD unitSI: value * unit_si is in SI units
  Index3 extent;                           ///< voxels, each >= 1 and < 2^31
  Index3 index_origin;  ///< index of the first voxel; not zero for OpenVDB input or a region of interest
  GridClass grid_class = GridClass::unknown;     ///< as a file of OpenVDB or NanoVDB says it
  std::optional<float> background;               ///< what lies around the domain, where that matters: a level set's
  ScalarType type = ScalarType::float32;         ///< as stored
  bool lengths = false;                          ///< of vectors, whose components are of `type`
  ValueMapping mapping;                          ///< from stored values to the volume's
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< world units per voxel, > 0
  std::array<double, 3> origin{0.0, 0.0, 0.0};   ///< world position of the centre of voxel (0, 0, 0)
  std::array<std::string, 3> spacing_from = {};  ///< what of the file says it, "attribute resolution"; may be empty
  std::array<std::string, 3> origin_from = {};   ///< the same of the origin
  std::uint64_t file_bytes = 0;                  ///< of the file at `path`
  std::int64_t mtime_ns = 0;                     ///< modification time, nanoseconds since 1970
  std::string files_digest;                      ///< FileStates of all files it lies in; empty where that is one
  std::vector<FileState> files;                  ///< all it lies in, as they were opened; none: not in files
  FieldDetails details;                          ///< for the sidecar

  /// Whether each value is one that is stored, and so one that `type` has; else it is computed from stored ones.
  bool values_as_stored() const { return !lengths && !mapping.scales(); }

  /// The voxels as a box in index space.
  Box domain() const { return {index_origin, index_origin + extent}; }
};

/// What the conversion of values to float32 lost. Non-finite values that the source itself holds
/// are not counted here.
struct ConversionLoss {
  std::uint64_t inexact = 0;   ///< values that are not representable in float32 and were rounded
  std::uint64_t overflow = 0;  ///< finite values that became infinite
  double max_abs_error = 0;    ///< largest |float32 - original| among the inexact ones
  std::uint64_t unmarked = 0;  ///< values that stand for "no data" and were taken as data (ValueMapping::keeps_missing)

  void add(const ConversionLoss& other) {
    inexact += other.inexact;
    overflow += other.overflow;
    max_abs_error = max_abs_error > other.max_abs_error ? max_abs_error : other.max_abs_error;
    unmarked += other.unmarked;
  }
  /// Of `n` times as many values.
  ConversionLoss times(std::uint64_t n) const { return {inexact * n, overflow * n, max_abs_error, unmarked * n}; }
};

/// How a source is best read; input to the block plan.
struct AccessShape {
  std::size_t bytes_per_voxel = 4;  ///< in the file
  Index3 chunk{0, 0, 0};            ///< chunk extent in voxels, zero where rows are contiguous
  Index3 chunk_origin{0, 0, 0};     ///< index of a corner of any chunk; chunks lie on its grid
};

/// Owned by one conversion. `read` may be called from several threads at once.
class VolumeSource {
 public:
  virtual ~VolumeSource() = default;

  virtual const SourceInfo& info() const = 0;
  virtual AccessShape access() const = 0;

  /// Reads `box` (index space, inside info().domain(), not empty) into `values`, which holds exactly
  /// box.voxels() floats, x fastest. Throws Error(input) with path and offset where bytes are
  /// missing, Error(io) where the device fails.
  virtual ConversionLoss read(const Box& box, std::span<float> values) = 0;

  /// True where reading is a copy out of memory (the file is in the page cache) and waits for nothing:
  /// callers then read on their working threads, in pieces that stay in a core's cache.
  virtual bool in_memory() const { return false; }

  /// The same as read, by the calling thread alone and without asking again whether the bytes are in
  /// memory: for callers that in_memory() told so.
  virtual ConversionLoss read_alone(const Box& box, std::span<float> values) { return read(box, values); }

  /// The same values where a device has them (format/packed/block_coder.h); null where none has. Lives as long as the
  /// source.
  virtual ResidentVolume* resident() { return nullptr; }

  /// Where its voxels lie in the volume that it is a sample of; null where it is none. Lives as long as the source.
  virtual const CellPlaces* places() const { return nullptr; }

  /// Boxes without a common voxel, of all voxels of `box` that have a value where info().mapping.gaps; known without
  /// reading any. `box` is as for read.
  virtual std::vector<Box> voxels_with_values(const Box& box) const { return {box}; }

  /// Cuts `box`, which is as for read, into parts whose voxels are known to repeat each other and others, where parts
  /// are leaves (8^3 voxels at multiples of 8 of the index) as far as they lie in `box`, and `by` divides 8.
  virtual std::vector<RepeatedPart> repeated_parts(const Box& box) const { return {{box}}; }
  /// Reads one of them: the value of each group, x fastest; the loss is that of all voxels. By the calling thread
  /// alone.
  virtual ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) {
    return read(part.box, values);
  }

  /// Where the values of `box`, which has whole leaves as far as the domain has them, lie in memory leaf by leaf; null
  /// where they have to be read. Lives as long as the source.
  virtual const HeldLeaves* held(const Box& /*box*/) const { return nullptr; }

  /// Memory that reading needs besides the callers' buffers and kStagingBytes, in bytes: decoded chunks.
  virtual std::uint64_t working_bytes() const { return 0; }

  /// Bytes read from the device or cache so far (for progress and the sidecar).
  virtual std::uint64_t bytes_read() const = 0;
};

}  // namespace weir
