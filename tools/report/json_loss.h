// What the conversion to float32 lost, as reports have it.
#pragma once

#include <nlohmann/json.hpp>

namespace weir {

/// The sidecar's conversion_loss, {inexact, overflow, max_abs_error}; `Loss` is Sidecar::ConversionLoss or what sources
/// say.
template <typename Loss>
nlohmann::ordered_json loss_json(const Loss& loss) {
  return {{"inexact", loss.inexact}, {"overflow", loss.overflow}, {"max_abs_error", loss.max_abs_error}};
}

}  // namespace weir
