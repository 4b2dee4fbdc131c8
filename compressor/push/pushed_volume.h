// Converts a volume that a simulation hands over slab by slab, and whose values need not exist once each call returns.
// The file is the same as that of any other conversion of the volume.
//
// A slab is copied into slices (ingest/plan/block_plan.h) of one leaf layer each. Beside the simulation, a thread
// surveys the slices that are complete and spools their leaves, but for those of one value, in the work directory, so
// that the end only has to select and encode. Meanwhile the directory needs room for these values as they are stored,
// for 16 bytes of each leaf and, unless records are held in memory, for 64 more, 216 more with a scene and 144 more of
// a packed one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "format/io/file_system.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// `slab` may be called by several threads at once; `end` once all of them have returned.
class PushedVolume {
 public:
  /// `info` says extent, index_origin, type, mapping, spacing, origin, path (for messages and the sidecar), dataset
  /// (the grid's name where not empty) and mtime_ns; format and file_bytes are set here. As convert_volume, but that
  /// options.memory is what weir takes besides what the process holds already, and that nothing can be continued:
  /// options.resume is not looked at. `control` is looked at in all calls. `files` must outlive the object. `workers`,
  /// at least 1, is the number of threads beside the simulation's.
  ///
  /// Takes the output's lock and room for what is kept of each leaf; throws Error, the same as convert_volume for the
  /// same reasons.
  PushedVolume(SourceInfo info, const ConversionOptions& options, const ConversionControl& control, FileSystem& files,
               std::size_t workers = 1);
  /// Leaves nothing where `end` was not called.
  ~PushedVolume();
  PushedVolume(const PushedVolume&) = delete;
  PushedVolume& operator=(const PushedVolume&) = delete;

  /// Takes planes [z0, z0 + nz), counted from the volume's first. `data` is their first voxel, of info's type in this
  /// machine's byte order, at any alignment; `stride` the bytes from one voxel to the next along x, y, z, any, also
  /// <= 0. Waits only while all of the memory is in use and the workers are making room.
  ///
  /// Throws Error(usage), and nothing is taken, where data is null, check_slab() throws, or a plane was given before.
  /// Throws Error(io) where the disk is full or fails, Error(interrupted) where control.cancel is set: that is
  /// then the answer of every later call, and nothing is left on the disk.
  void slab(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride);
  /// Without gaps, x fastest: Fortran's a(x, y, z), C's a[z][y][x].
  void slab(std::int64_t z0, std::int64_t nz, const void* data);

  /// Throws Error(usage) where planes are not in the volume, or the strides lead out of the address space.
  void check_slab(std::int64_t z0, std::int64_t nz, const std::array<std::int64_t, 3>& stride) const;

  /// The same in two steps, for values that arrive later. `expect` checks and takes the planes, as slab does without
  /// data; `fill` gives the values of planes that were expected, in any number of calls, each plane once, or all of
  /// them come with `end`.
  void expect(std::int64_t z0, std::int64_t nz);
  void fill(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride);
  /// Ends the push with `error`, unless it has ended already: values that were expected will not come. That is then the
  /// answer of every later call, and nothing is left on the disk.
  void fail(const Error& error);

  /// Whether there is memory for the end of a volume that comes with it, whose source takes that much.
  bool has_room_for(std::uint64_t working_bytes) const;

  /// Extent, type and path as the push was begun.
  const SourceInfo& info() const;

  /// Writes the volume and its sidecar, which it returns; the volume has the bytes that convert_volume gives for the
  /// same values and options. Sidecar::Timing is of this call. Throws Error(usage) naming the planes that are missing,
  /// which can still be given, and where slabs are still being taken or expected. Any other Error is final, as for
  /// slab, and of the output nothing is left.
  Sidecar end();
  /// The same of a volume whose planes were all expected and none of them filled: `whole` has their values.
  Sidecar end(VolumeSource& whole);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace weir
