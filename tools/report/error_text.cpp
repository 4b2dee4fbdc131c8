#include "tools/report/error_text.h"

#include "format/base/printable.h"
#include "format/base/text.h"
#include "format/sidecar/valid_voxels.h"

namespace weir {

std::string largest_error_text(double max_abs, double range, const std::string& units) {
  std::string text = short_number(max_abs);
  if (!units.empty()) text += cat(' ', printable(units));
  if (range > 0) text += cat(" (", short_number(100 * (max_abs / range)), " % of the range)");
  return text;
}

std::string error_text(const Sidecar& sidecar, const Sidecar::CertifiedError& error) {
  if (error.lossless) return lossless_text(sidecar);
  return cat("PSNR ", error.psnr_db ? short_number(*error.psnr_db) + " dB" : "none", ", largest error ",
             largest_error_text(error.max_abs, sidecar.value_range[1] - sidecar.value_range[0], sidecar.source.units));
}

std::string gradient_text(const Sidecar::GradientError& gradient, const std::string& units) {
  if (gradient.voxels == 0) return "not defined: every voxel is at or beside one that is not finite";
  std::string text = gradient.relative_rms ? cat("relative rms ", short_number(*gradient.relative_rms), ", ") : "";
  text += cat("largest error ", short_number(gradient.max_abs), units.empty() ? "" : cat(" ", printable(units)),
              " per world unit");
  if (gradient.left_out == 0) return text;
  return cat(text, "; ", gradient.left_out, gradient.left_out == 1 ? " voxel" : " voxels",
             " at or beside one that is not finite left out");
}

std::string rounded_text(const Sidecar::ConversionLoss& loss) {
  std::string text;
  if (loss.inexact > 0) {
    text = cat(loss.inexact, loss.inexact == 1 ? " value" : " values", " rounded to float32, by up to ",
               short_number(loss.max_abs_error));
  }
  if (loss.overflow > 0) {
    text += cat(text.empty() ? "" : ", ", loss.overflow, loss.overflow == 1 ? " value" : " values",
                " beyond float32 infinite");
  }
  return text;
}

}  // namespace weir
