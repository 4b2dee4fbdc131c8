// Converts a volume that a simulation hands over slab by slab. The simulation may discard a slab's values when the call
// returns. The file is the same as that of any other conversion of the volume.
//
// A slab is copied into slices (ingest/plan/block_plan.h) of one leaf layer each. Worker threads beside the simulation
// survey complete slices and spool their leaves, except leaves of one value, to the work directory, so that the end
// only has to select and encode. Until then the directory needs room for the spooled values as they are stored and for
// 16 bytes per leaf. Unless records are held in memory, it needs 64 bytes per leaf more, 216 more with a scene, and 144
// more for a packed file.
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

/// Several threads may call slab() at once. Call end() after all these calls have returned.
class PushedVolume {
 public:
  /// `info` gives extent, index_origin, type, mapping, spacing, origin, path (for messages and the sidecar), dataset
  /// (the grid's name if not empty) and mtime_ns. The constructor sets format and file_bytes. The other arguments are
  /// as for convert_volume(), with two differences: options.memory comes on top of the memory that the process holds
  /// already, and options.resume is ignored because a push cannot be continued. All calls use `control`. `files` must
  /// outlive the object. `workers`, at least 1, is the number of threads beside the simulation's.
  ///
  /// Takes the output's lock and reserves room for each leaf's records. Throws the same Errors as convert_volume() for
  /// the same reasons.
  PushedVolume(SourceInfo info, const ConversionOptions& options, const ConversionControl& control, FileSystem& files,
               std::size_t workers = 1);
  /// Leaves nothing on the disk if end() was not called.
  ~PushedVolume();
  PushedVolume(const PushedVolume&) = delete;
  PushedVolume& operator=(const PushedVolume&) = delete;

  /// Takes planes [z0, z0 + nz), counted from the volume's first plane. `data` points to their first voxel, of info's
  /// type in this machine's byte order, at any alignment. `stride` gives the bytes from one voxel to the next along x,
  /// y, z; any number, also <= 0. Waits only while all memory is in use and the workers are making room.
  ///
  /// Throws Error(usage) and takes nothing if data is null, check_slab() throws, or a plane was given before. Throws
  /// Error(io) if the disk is full or fails, and Error(interrupted) if control.cancel is set. After either of these,
  /// every later call throws the same error, and nothing is left on the disk.
  void slab(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride);
  /// Takes planes that lie without gaps, x fastest: Fortran's a(x, y, z), C's a[z][y][x].
  void slab(std::int64_t z0, std::int64_t nz, const void* data);

  /// Throws Error(usage) if planes are not in the volume, or if the strides lead out of the address space.
  void check_slab(std::int64_t z0, std::int64_t nz, const std::array<std::int64_t, 3>& stride) const;

  /// Do the same as slab() in two steps, for values that arrive later. expect() checks and takes the planes, as slab()
  /// does, but without data. fill() gives the values of expected planes in any number of calls, each plane once.
  /// Instead of fill(), end(whole) can give the values of all planes.
  void expect(std::int64_t z0, std::int64_t nz);
  void fill(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride);
  /// Ends the push with `error`, unless it has ended already, because expected values will not come. Every later call
  /// throws `error`, and nothing is left on the disk.
  void fail(const Error& error);

  /// Returns whether there is memory for end(whole) if the source `whole` takes `working_bytes`.
  bool has_room_for(std::uint64_t working_bytes) const;

  /// Returns extent, type and path as given at the beginning of the push.
  const SourceInfo& info() const;

  /// Writes the volume and its sidecar, and returns the sidecar. The volume has the bytes that convert_volume() gives
  /// for the same values and options. Sidecar::Timing covers this call. Throws Error(usage) that names missing planes,
  /// which can still be given, and Error(usage) if slabs are still being taken or expected. Any other Error is final,
  /// as for slab(), and nothing is left of the output.
  Sidecar end();
  /// Does the same for a volume with all planes expected and none of them filled. `whole` has their values.
  Sidecar end(VolumeSource& whole);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace weir
