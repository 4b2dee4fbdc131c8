#include "compressor/default_notice.h"

#include <cmath>

#include "compressor/select/budget.h"
#include "format/base/text.h"
#include "format/sidecar/valid_voxels.h"

namespace weir {

Message default_notice(const Sidecar& sidecar, const std::string& output) {
  const bool shown = sidecar.visible && sidecar.visible->blocks > 0;
  const Sidecar::CertifiedError& error = shown ? sidecar.visible->error : sidecar.error;
  const std::string& kind = sidecar.budget.kind;
  if (kind == "lossless" || kind == "psnr") {
    const std::string kept = error.psnr_db ? cat("with ", short_number(*error.psnr_db), " dB") : lossless_text(sidecar);
    return compose(output, ": no budget was given, and ", option("rate", Budget{}.rate), " would keep less than ",
                   kDefaultLeastDb, " dB of so small a volume; written ", kept, ": ", sidecar.budget.file_bytes,
                   " bytes, rate ", short_number(sidecar.budget.rate), "; give a budget for another size");
  }
  if (!error.psnr_db || !(*error.psnr_db < kDefaultLeastDb)) return {};
  return compose(output, ": no budget was given, and rate ", short_number(sidecar.budget.rate), " keeps ",
                 short_number(*error.psnr_db), " dB, an error (RMSE) of ", short_number(100 * std::sqrt(error.nmse)),
                 " % of the value range; give a smaller ", option("rate"), ", or ", option("psnr", 60),
                 " for instance");
}

}  // namespace weir
