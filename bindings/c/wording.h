// Words options with the names of weir.h.
#pragma once

#include <string>

#include "format/base/message.h"

namespace weir::c {

/// Returns "budget (WEIR_BUDGET_PSNR)", "WEIR_ENCODING_FLOAT", "extent" or "memory 64.0 MiB": budgets and choices by
/// their enumerators, everything else by its member.
std::string c_wording(const OptionName& option);

}  // namespace weir::c
