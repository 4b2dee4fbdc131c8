// Sources of volumes, one implementation per file format. All of them read boxes of float32 values, x fastest, into
// the caller's memory. Besides, they need only the memory of kStagingBytes and working_bytes().
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
  std::vector<std::int64_t> index;         ///< position on the leading axes of an array with more than three axes
  std::array<std::string, 3> axis_labels;  ///< of x, y, z, x fastest in memory; empty if the file names none
  std::string units;                       ///< units of the values as in the file, "kg m-3"; else empty
  std::optional<double> unit_si;           ///< openPMD unitSI: value * unit_si is in SI units
  Index3 extent;                           ///< voxels, each >= 1 and < 2^31
  Index3 index_origin;  ///< index of the first voxel; can be nonzero for OpenVDB input or a region of interest
  GridClass grid_class = GridClass::unknown;     ///< as an OpenVDB or NanoVDB file says it
  std::optional<float> background;               ///< value around the domain, if it matters (level sets)
  ScalarType type = ScalarType::float32;         ///< as stored
  bool lengths = false;                          ///< the values are lengths of vectors with components of `type`
  ValueMapping mapping;                          ///< from stored values to the volume's
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< world units per voxel, > 0
  std::array<double, 3> origin{0.0, 0.0, 0.0};   ///< world position of the centre of voxel (0, 0, 0)
  std::array<std::string, 3> spacing_from = {};  ///< where the file gives it, "attribute resolution"; may be empty
  std::array<std::string, 3> origin_from = {};   ///< where the file gives the origin
  std::uint64_t file_bytes = 0;                  ///< of the file at `path`
  std::int64_t mtime_ns = 0;                     ///< modification time, nanoseconds since 1970
  std::string files_digest;      ///< FileStates digest of all files of the volume; empty if there is only one
  std::vector<FileState> files;  ///< all files of the volume, as they were opened; empty if it is not in files
  FieldDetails details;          ///< for the sidecar

  /// Returns whether every value is a stored value, which `type` can hold. If false, values are computed from stored
  /// ones.
  bool values_as_stored() const { return !lengths && !mapping.scales(); }

  /// The voxels as a box in index space.
  Box domain() const { return {index_origin, index_origin + extent}; }
};

/// What the conversion of values to float32 lost. Non-finite values of the source itself are not counted.
struct ConversionLoss {
  std::uint64_t inexact = 0;   ///< values that are not representable in float32 and were rounded
  std::uint64_t overflow = 0;  ///< finite values that became infinite
  double max_abs_error = 0;    ///< largest |float32 - original| among the inexact ones
  std::uint64_t unmarked = 0;  ///< values that mean "no data" and were taken as data (ValueMapping::keeps_missing)

  void add(const ConversionLoss& other) {
    inexact += other.inexact;
    overflow += other.overflow;
    max_abs_error = max_abs_error > other.max_abs_error ? max_abs_error : other.max_abs_error;
    unmarked += other.unmarked;
  }
  /// Returns the loss of `n` times as many values.
  ConversionLoss times(std::uint64_t n) const { return {inexact * n, overflow * n, max_abs_error, unmarked * n}; }
};

/// How a source is best read. The block plan uses it.
struct AccessShape {
  std::size_t bytes_per_voxel = 4;  ///< in the file
  Index3 chunk{0, 0, 0};            ///< chunk extent in voxels, zero if rows are contiguous
  Index3 chunk_origin{0, 0, 0};     ///< index of a corner of any chunk; chunks lie on its grid
};

/// A volume that one conversion owns. `read` may be called from several threads at once.
class VolumeSource {
 public:
  virtual ~VolumeSource() = default;

  virtual const SourceInfo& info() const = 0;
  virtual AccessShape access() const = 0;

  /// Reads `box` (index space, inside info().domain(), not empty) into `values`, which holds exactly box.voxels()
  /// floats, x fastest. Throws Error(input) with path and offset if bytes are missing, Error(io) if the device fails.
  virtual ConversionLoss read(const Box& box, std::span<float> values) = 0;

  /// Returns whether reading is a copy out of memory (the file is in the page cache) and waits for nothing. Callers
  /// then read on their working threads, in pieces that stay in a core's cache.
  virtual bool in_memory() const { return false; }

  /// Reads as read() does, but on the calling thread alone and without checking again whether the bytes are in
  /// memory. For callers that got true from in_memory().
  virtual ConversionLoss read_alone(const Box& box, std::span<float> values) { return read(box, values); }

  /// Returns the volume on a device that already holds its values (format/packed/block_coder.h), or null. It lives as
  /// long as the source.
  virtual ResidentVolume* resident() { return nullptr; }

  /// Returns where the voxels lie in another volume, if this source is a sample of one; otherwise null. It lives as
  /// long as the source.
  virtual const CellPlaces* places() const { return nullptr; }

  /// Returns disjoint boxes of exactly the voxels of `box` that have a value, for volumes with info().mapping.gaps.
  /// Reads no values. `box` is as for read().
  virtual std::vector<Box> voxels_with_values(const Box& box) const { return {box}; }

  /// Cuts `box` (as for read()) into parts. The voxels of some parts are known to repeat in groups of `by`, which
  /// divides 8; other parts have `by` 1. If there are several parts, each consists of whole leaves (8^3 voxels at
  /// multiples of 8 of the index), cut to `box`.
  virtual std::vector<RepeatedPart> repeated_parts(const Box& box) const { return {{box}}; }
  /// Reads one part of repeated_parts() on the calling thread alone: the value of each group, x fastest. The loss is
  /// that of all voxels.
  virtual ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) {
    return read(part.box, values);
  }

  /// Returns the values of `box` that lie in memory leaf by leaf, or null if they have to be read. `box` has whole
  /// leaves as far as the domain has them. The object lives as long as the source.
  virtual const HeldLeaves* held(const Box& /*box*/) const { return nullptr; }

  /// Returns the bytes that reading needs besides the callers' buffers and kStagingBytes: decoded chunks.
  virtual std::uint64_t working_bytes() const { return 0; }

  /// Returns the bytes read so far from the device or cache (for progress and the sidecar).
  virtual std::uint64_t bytes_read() const = 0;
};

}  // namespace weir
