#include "compressor/result_notices.h"

#include <cmath>

#include "compressor/default_notice.h"
#include "compressor/scene_notice.h"

namespace weir {
namespace {

// Returns a line about rounding to float32, which no certificate counts. Empty if the rounding is at most 1 % of the
// error that the file has or may have.
Message rounding_notice(const Sidecar& sidecar, const Budget& budget) {
  const Sidecar::ConversionLoss& loss = sidecar.conversion_loss;
  double counted = sidecar.error.max_abs;
  if (budget.kind == Budget::Kind::max_error) counted = budget.target;
  if (budget.kind == Budget::Kind::psnr) {
    counted = (sidecar.value_range[1] - sidecar.value_range[0]) / std::pow(10, budget.target / 20);
  }
  if (loss.inexact == 0 || loss.max_abs_error <= 0.01 * counted) return {};
  return cat(sidecar.source.path, ": ", loss.inexact, loss.inexact == 1 ? " value was" : " values were",
             " rounded to float32, which files hold, by up to ", loss.max_abs_error, ", and no error counts that");
}

Message overflow_notice(const Sidecar& sidecar) {
  const std::uint64_t overflow = sidecar.conversion_loss.overflow;
  if (overflow == 0) return {};
  return cat(sidecar.source.path, ": ", overflow, overflow == 1 ? " value is" : " values are",
             " finite but beyond the 3.4e+38 of float32, and infinite in the file");
}

}  // namespace

void say_loss(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice) {
  if (!notice) return;
  if (const Message line = rounding_notice(sidecar, options.budget); !line.empty()) notice(line);
  if (const Message line = overflow_notice(sidecar); !line.empty()) notice(line);
}

void say_result(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice) {
  if (!notice) return;
  if (const Message line = scene_notice(sidecar, options.output); !line.empty()) notice(line);
  say_loss(sidecar, options, notice);
  if (options.budget.kind != Budget::Kind::automatic) return;
  if (const Message line = default_notice(sidecar, options.output); !line.empty()) notice(line);
}

}  // namespace weir
