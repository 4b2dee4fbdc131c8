// Reads the pixels of a chart.
#pragma once

#include <string>

#include "gpu/image/png_input.h"
#include "tests/support/run_command.h"

namespace weir::test {

/// Returns the picture in the bytes of a PNG file.
inline Image picture_of(const std::string& png) {
  const TemporaryDirectory directory;
  write_file(directory / "a.png", png);
  return read_png(directory / "a.png");
}

}  // namespace weir::test
