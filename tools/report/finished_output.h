// What a conversion finds at the path of its output, for `weir convert --skip-done`. Two small reads and one of the
// volume's nodes; values are read only beside what a killed commit left.
#pragma once

#include <optional>
#include <string>

#include "compressor/conversion_options.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct FinishedOutput {
  enum class State {
    absent,      ///< neither volume nor sidecar
    done,        ///< the result of this very conversion: `sidecar` is its record
    stale,       ///< weir made it of the same source, which has changed since, or with other options, or not to the end
    foreign,     ///< weir did not make it of this source; `reason` says what it is
    unreadable,  ///< the system does not give its sidecar now, so that nobody knows: `reason` is the error's line
  };
  State state = State::absent;
  std::optional<Sidecar> sidecar;
  std::string reason;  ///< why it is not done
};

/// At options.output; options.provenance has those of the command line, as given_options says them, and the ones that
/// do not change the volume's bytes (memory, threads, places) need not agree. Done means: the sidecar names the same
/// source, by its real path where it has that, dataset, size, modification time and states of its files, the same
/// options, however they were written, and a scene that said the same, and the volume is the sidecar's
/// (is_of.h). Throws nothing for what stands there.
FinishedOutput find_output(const SourceInfo& source, const ConversionOptions& options);

/// Throws Error(usage) where `output` is the input itself, or a directory.
void check_output(const std::string& input, const std::string& output);

}  // namespace weir
