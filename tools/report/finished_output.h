// Finds out what stands at the path of an output, for `weir convert --skip-done`. Two small reads and one read of the
// volume's nodes; values are read only if a killed commit left files behind.
#pragma once

#include <optional>
#include <string>

#include "compressor/conversion_options.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct FinishedOutput {
  enum class State {
    absent,      ///< neither volume nor sidecar exists
    done,        ///< the result of exactly this conversion: `sidecar` is its record
    stale,       ///< weir made it of the same source, but the source or options changed, or it is incomplete
    foreign,     ///< weir did not make it of this source; `reason` says what it is
    unreadable,  ///< the system cannot read the sidecar now, so the state is unknown: `reason` is the error
  };
  State state = State::absent;
  std::optional<Sidecar> sidecar;
  std::string reason;  ///< why the state is not `done`
};

/// Inspects options.output. options.provenance holds the options of the command line, as given_options returns them;
/// options that do not change the volume's bytes (memory, threads, places) may differ. The state is `done` if the
/// sidecar names the same source (real path if recorded, dataset, size, modification time and file states), the same
/// options in any spelling, and a scene with the same content, and if the volume is the sidecar's (is_of.h). Throws
/// nothing for the files found there.
FinishedOutput find_output(const SourceInfo& source, const ConversionOptions& options);

/// Throws Error(usage) if `output` is the input itself or a directory.
void check_output(const std::string& input, const std::string& output);

}  // namespace weir
