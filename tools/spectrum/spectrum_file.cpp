#include "tools/spectrum/spectrum_file.h"

#include <span>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/drivers/driver.h"
#include "tools/spectrum/block_transform.h"
#include "tools/spectrum/spectrum_plot.h"
#include "tools/spectrum/spectrum_report.h"

namespace weir {

SpectrumFile::SpectrumFile(FileSystem& files, const std::string& path) {
  if (!has_fftw()) throw usage_error("--spectrum: this weir was built without FFTW; build it with -DWEIR_FFTW=ON");
  if (!path.ends_with(".csv")) {
    if (!path.ends_with(".png") && !path.ends_with(".svg")) {
      throw usage_error(cat("--spectrum is \"", path, "\", it must be FILE.png, FILE.svg or FILE.csv"));
    }
    chart_ = plot_format(path, "spectrum");
    load_driver("plot", path + ": is to be a chart");
  }
  file_.emplace(files, path, true);
}

void SpectrumFile::write(const PowerSpectrum& spectrum, const std::string& title) {
  const std::string bytes = chart_ ? spectrum_chart(spectrum, title, *chart_) : spectrum_csv(spectrum);
  file_->file().write_at(0, std::as_bytes(std::span(bytes)));
  file_->commit();
}

}  // namespace weir
