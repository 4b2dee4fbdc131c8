// Adds the file's path to the errors of a volume.
#pragma once

#include <string>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

/// Returns what `work` returns, which loads or renders the volume of the file `path`. An error of kind usage or input
/// that `work` throws then begins with "PATH: ".
template <class Work>
auto naming_volume(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const bool of_volume = error.kind() == ErrorKind::usage || error.kind() == ErrorKind::input;
    if (!of_volume || std::string_view(error.what()).starts_with(cat(path, ": "))) throw;
    throw Error(error.kind(), compose(path, ": ", error.message()), error.system_failure());
  }
}

}  // namespace weir
