// A volume that the processes of an MPI job hold in pieces and hand over, each the
// boxes that are its own; in the end, one file, the same as a conversion of all
// of it.
//
// Voxels go to one spool that all processes share (compressor/push/leaf_spool.h), where
// the leaves that several of them have a part in come together; nobody ever holds
// the volume.
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

/// All ranks make one of the same volume and options, end it and destroy it together; `box` concerns one rank alone.
class PushedBoxes {
 public:
  /// `info` as for PushedVolume; options.memory is what weir takes in each process besides what that holds. Takes the
  /// output's lock and removes what an interrupted conversion of it had left, with a notice. Throws Error as
  /// convert_volume does.
  PushedBoxes(SourceInfo info, const ConversionOptions& options, const ConversionControl& control, MpiTeam& team);
  PushedBoxes(const PushedBoxes&) = delete;
  PushedBoxes& operator=(const PushedBoxes&) = delete;

  /// Takes the voxels of `box`, counted from the volume's first: `data` is its lowest one, of info's type in this
  /// machine's byte order, `stride` the bytes from one voxel to the next along x, y, z. One call at a time. Throws
  /// Error(usage), and nothing is taken, where the box is empty or not in the volume, data is null, or the strides lead
  /// out of the address space; Error(io) where the disk fails, Error(interrupted) where control.cancel is set, which
  /// then is the answer of end() too.
  void box(const Box& box, const void* data, const std::array<std::int64_t, 3>& stride);

  /// Writes the volume and its sidecar, which it returns. Throws Error(usage) naming a box that two processes gave, or
  /// one that nobody gave: it can still be given. Any other Error is final, and of the output nothing is left.
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
  std::vector<Box> given_;  // by this rank, in index space
  std::optional<Error> failure_;
};

}  // namespace weir
