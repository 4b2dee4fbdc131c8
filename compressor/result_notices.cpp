#include "compressor/result_notices.h"

#include "compressor/default_notice.h"
#include "compressor/scene_notice.h"

namespace weir {
namespace {

// What no certificate counts, where the user set a bound that it exceeds, or nearly: values were rounded to float32
// before.
Message rounding_notice(const Sidecar& sidecar, const Budget& budget) {
  const Sidecar::ConversionLoss& loss = sidecar.conversion_loss;
  const bool bounded = budget.kind == Budget::Kind::max_error && loss.max_abs_error > 0.01 * budget.target;
  if (loss.inexact == 0 || (!bounded && budget.kind != Budget::Kind::lossless)) return {};
  return compose(sidecar.source.path, ": ", loss.inexact, loss.inexact == 1 ? " value was" : " values were",
                 " rounded to float32, by up to ", loss.max_abs_error, ", besides what ",
                 option(budget.kind == Budget::Kind::lossless ? "lossless" : "max-error"),
                 " allows: files hold float32");
}

}  // namespace

void say_result(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice) {
  if (!notice) return;
  if (const Message line = scene_notice(sidecar, options.output); !line.empty()) notice(line);
  if (const Message line = rounding_notice(sidecar, options.budget); !line.empty()) notice(line);
  if (options.budget.kind != Budget::Kind::automatic) return;
  if (const Message line = default_notice(sidecar, options.output); !line.empty()) notice(line);
}

}  // namespace weir
