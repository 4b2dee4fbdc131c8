// The output file of a spectrum: FILE.png or FILE.svg, a chart, or FILE.csv, a table.
#pragma once

#include <optional>
#include <string>

#include "format/io/file_system.h"
#include "format/output/partial_file.h"
#include "tools/plot/plot_canvas.h"
#include "tools/spectrum/power_spectrum.h"

namespace weir {

class SpectrumFile {
 public:
  /// Opens the output, so that a fault is reported before the work. `files` must outlive the object; a file at `path`
  /// is replaced. Throws Error(usage) for another ending and without FFTW, and as load_driver and PartialFile.
  SpectrumFile(FileSystem& files, const std::string& path);

  /// Writes the file. `title`: over the chart. On failure throws Error(io) and leaves the previous file.
  void write(const PowerSpectrum& spectrum, const std::string& title);

 private:
  std::optional<PlotFormat> chart_;
  std::optional<PartialFile> file_;
};

}  // namespace weir
