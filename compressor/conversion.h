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

/// Converts and returns the sidecar that was written. Throws Error; then what was there before is untouched, and of the
/// output nothing is left but, where it can be continued (journal.h), what the hidden directory beside it holds: the
/// same call goes on from there and ends with the same bytes. Where `team` has other ranks, each calls this with a
/// source of the same volume, the same options and a file system in which they find the files of each other; what is
/// interrupted is lost then, and options.memory and options.threads are those of each process.
Sidecar convert_volume(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                       FileSystem& files, Team& team = no_team());

/// The same into an output whose lock the caller holds, by the work directory beside it; options.memory is what this
/// takes besides what the process holds already, and what is interrupted is lost.
Sidecar convert_into(OutputFiles& output, WorkDirectory& work, VolumeSource& source, const ConversionOptions& options,
                     const ConversionControl& control, Team& team);

}  // namespace weir
