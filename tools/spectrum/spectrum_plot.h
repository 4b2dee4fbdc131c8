// The chart of a spectrum: how much of the source's power the file keeps, and how large its error is, by wave number.
#pragma once

#include <string>

#include "tools/plot/plot_canvas.h"
#include "tools/spectrum/power_spectrum.h"

namespace weir {

/// Returns the bytes of a chart file, 900 x 600 pixels, both axes logarithmic: power of the file and of the error as a
/// share of the source's power, for shells in which that is not 0. Throws as make_plot_canvas.
std::string spectrum_chart(const PowerSpectrum& spectrum, const std::string& title, PlotFormat format);

}  // namespace weir
