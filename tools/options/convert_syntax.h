// What a configuration of the daemon may say of a conversion: the input and
// conversion options of `weir convert`, checked as that command checks them.
#pragma once

#include "daemon/config/convert_syntax.h"

namespace weir {

ConvertSyntax convert_syntax();

}  // namespace weir
