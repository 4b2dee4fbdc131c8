// A volume that the processes of an MPI job hold in pieces. Each hands over its own boxes; the result is one file, the
// same as from a conversion of the whole volume.
//
// Voxels go to one spool that all processes share (compressor/push/leaf_spool.h). There the leaves are put together
// to which several processes contribute; no process ever holds the volume.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bindings/mpi/mpi_team.h"
#include "compressor/conversion.h"
#include "compressor/push/leaf_spool.h"
#include "compressor/resume/work_directory.h"
#include "format/base/error.h"
#include "format/io/file_system.h"
#include "format/output/output_files.h"

namespace weir {

/// All ranks make one object for the same volume and options, end it and destroy it together; box() concerns only one
/// rank.
class PushedBoxes {
 public:
  /// `info` is as for PushedVolume; options.memory is the memory that weir takes in each process, besides what the
  /// process holds. Takes the output's lock and removes what an interrupted conversion of it has left, with a notice.
  /// Throws Error as convert_volume().
  PushedBoxes(SourceInfo info, const ConversionOptions& options, const ConversionControl& control, MpiTeam& team);
  PushedBoxes(const PushedBoxes&) = delete;
  PushedBoxes& operator=(const PushedBoxes&) = delete;

  /// Takes the voxels of `box`, counted from the volume's first voxel. `data` is the box's lowest voxel, of info's type
  /// in this machine's byte order; `stride` is the bytes from one voxel to the next along x, y, z. One call at a time.
  /// Throws Error(usage), and takes nothing, if the box is empty or not in the volume, if data is null, or if the
  /// strides lead out of the address space. Throws Error(io) if the disk fails, and Error(interrupted) if
  /// control.cancel is set; end() then throws the same.
  void box(const Box& box, const void* data, const std::array<std::int64_t, 3>& stride);

  /// Writes the volume and its sidecar, and returns the sidecar. Throws Error(usage) that names a box that nobody gave,
  /// which can still be given, or voxels that were given twice, after which no end() succeeds. Any other Error is final
  /// and leaves nothing of the output.
  Sidecar end();

 private:
  void check_complete();

  MpiTeam& team_;
  SourceInfo info_;
  ConversionOptions options_;
  const ConversionControl& control_;
  std::unique_ptr<FileSystem> local_;
  std::unique_ptr<FileSystem> shared_;
  OutputFiles output_;
  WorkDirectory work_;
  std::shared_ptr<File> values_;
  std::shared_ptr<File> states_;
  LeafSpool spool_;
  std::vector<Box> given_;  // boxes that this rank gave, in index space
  std::optional<Error> failure_;
};

}  // namespace weir
