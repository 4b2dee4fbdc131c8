// The error of a file as lines for people say it.
#pragma once

#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// A largest error, absolute and beside the values' range: "0.01234 K (0.31 % of the range)". `range` is the width of
/// the range, 0 where there is none; `units` may be empty.
std::string largest_error_text(double max_abs, double range, const std::string& units);

/// "PSNR 54.3 dB, largest error 0.01234 K (0.31 % of the range)", "lossless" or "lossless over valid voxels".
/// `error` is one of the sidecar's.
std::string error_text(const Sidecar& sidecar, const Sidecar::CertifiedError& error);

/// "relative rms 0.021, largest error 1.5 K per world unit", and how many voxels were left out.
std::string gradient_text(const Sidecar::GradientError& gradient, const std::string& units);

/// "512 values rounded to float32, by up to 3.723e-09": what a file loses before it is coded, of values that float32
/// does not hold; empty where all are held.
std::string rounded_text(const Sidecar::ConversionLoss& loss);

}  // namespace weir
