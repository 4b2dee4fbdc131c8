// What stands at an output's place, seen from the conversion that would write
// it: the question behind `weir convert --skip-done`. Two small reads and one of
// the volume's nodes; no values are read, that is for `weir verify`.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "format/sidecar.h"
#include "ingest/volume_source.h"

namespace weir {

struct FinishedOutput {
  enum class State {
    absent,  ///< neither volume nor sidecar
    done,    ///< the result of this very conversion: `sidecar` is its record
    stale,   ///< weir made it of the same source, which has changed since, or with other options, or not to the end
    foreign  ///< weir did not make it of this source; `reason` says what it is
  };
  State state = State::absent;
  std::optional<Sidecar> sidecar;
  std::string reason;  ///< why it is not done
};

/// `options` are those of the conversion, as given_options says them; the ones that do not change the
/// volume's bytes (memory, threads, places) need not agree. Done means: the sidecar names the same source
/// path, dataset, size and modification time and the same options, and the volume has the size and the head
/// checksum that the sidecar says. Throws nothing for what stands there.
FinishedOutput find_output(const std::string& output, const SourceInfo& source,
                           const std::map<std::string, std::string>& options);

}  // namespace weir
