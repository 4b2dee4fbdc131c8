// The loss of the conversion to float32, as reports hold it.
#pragma once

#include <nlohmann/json.hpp>

namespace weir {

/// Returns {inexact, overflow, max_abs_error}, as in the sidecar's conversion_loss. `Loss` is Sidecar::ConversionLoss
/// or the loss type of sources.
template <typename Loss>
nlohmann::ordered_json loss_json(const Loss& loss) {
  return {{"inexact", loss.inexact}, {"overflow", loss.overflow}, {"max_abs_error", loss.max_abs_error}};
}

}  // namespace weir
