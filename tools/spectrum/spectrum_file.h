// Where a spectrum goes: FILE.png or FILE.svg, a chart, or FILE.csv, a table.
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
  /// Takes the place, so that what is wrong with it is said before the work. `files` must outlive the object; a file at
  /// `path` is replaced. Throws Error(usage) for another ending and without FFTW, and as load_driver and PartialFile.
  SpectrumFile(FileSystem& files, const std::string& path);

  /// `title`: over the chart. Throws Error(io), and leaves what was there.
  void write(const PowerSpectrum& spectrum, const std::string& title);

 private:
  std::optional<PlotFormat> chart_;
  std::optional<PartialFile> file_;
};

}  // namespace weir
