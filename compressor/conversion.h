// One conversion: a volume in, a NanoVDB file of exactly the asked size and its
// sidecar out, under a memory ceiling, all or nothing.
#pragma once

#include "compressor/conversion_control.h"
#include "compressor/conversion_options.h"
#include "compressor/team/team.h"
#include "format/io/file_system.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

class OutputFiles;
class WorkDirectory;

/// Converts `source` and returns the sidecar that was written. If it throws an Error, an earlier output is untouched
/// and nothing of the new output is left, except the hidden directory beside the output if the conversion can be
/// continued (journal.h): the same call then continues and gives the same bytes.
/// If `team` has other ranks, each rank calls this function with a source of the same volume, the same options and a
/// file system in which the ranks find each other's files. options.memory and options.threads then apply to each
/// process, and an interrupted conversion is lost. A team sets options.resume to Resume::off; with any other value,
/// the files that an earlier conversion left stay.
Sidecar convert_volume(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                       FileSystem& files, Team& team = no_team());

/// Converts `source` into an output whose lock the caller holds, with `work` as the work directory beside the output.
/// options.memory comes on top of the memory that the process holds already. An interrupted conversion is lost.
Sidecar convert_into(OutputFiles& output, WorkDirectory& work, VolumeSource& source, const ConversionOptions& options,
                     const ConversionControl& control, Team& team);

}  // namespace weir
