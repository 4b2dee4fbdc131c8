// Texts for people about the error of a file.
#pragma once

#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// Returns a largest error, absolute and relative to the range of the values: "0.01234 K (0.31 % of the range)".
/// `range` is the width of the range, 0 if there is none; `units` may be empty.
std::string largest_error_text(double max_abs, double range, const std::string& units);

/// Returns "PSNR 54.3 dB, largest error 0.01234 K (0.31 % of the range)", "lossless" or "lossless over valid voxels".
/// `error` is one of the errors in `sidecar`.
std::string error_text(const Sidecar& sidecar, const Sidecar::CertifiedError& error);

/// Returns "relative rms 0.021, largest error 1.5 K per world unit", and how many voxels were left out.
std::string gradient_text(const Sidecar::GradientError& gradient, const std::string& units);

/// Returns what the values lost in the conversion to float32, before coding: "512 values rounded to float32, by up to
/// 3.723e-09". Empty if float32 holds all values.
std::string rounded_text(const Sidecar::ConversionLoss& loss);

}  // namespace weir
