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

/// Converts and returns the sidecar that was written. Throws Error; then an earlier output is untouched and nothing of
/// the new one is left, except, where it can be continued (journal.h), the hidden directory beside it: the same call
/// continues from there and gives the same bytes. Where `team` has other ranks, each calls this with a source of the
/// same volume, the same options and a file system in which they find each other's files; an interrupted conversion is
/// lost then, and options.memory and options.threads are those of each process. A team's options.resume is Resume::off;
/// with another, what an earlier conversion left stays.
Sidecar convert_volume(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                       FileSystem& files, Team& team = no_team());

/// The same for an output whose lock the caller holds, with the work directory beside it; options.memory counts besides
/// what the process holds already, and an interrupted conversion is lost.
Sidecar convert_into(OutputFiles& output, WorkDirectory& work, VolumeSource& source, const ConversionOptions& options,
                     const ConversionControl& control, Team& team);

}  // namespace weir
