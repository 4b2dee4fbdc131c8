#include "tools/report/error_line.h"

#include <cstdio>

#include "format/base/printable.h"

namespace weir {

void print_error_line(const std::string& message) { std::fprintf(stderr, "weir: %s\n", one_line(message).c_str()); }

}  // namespace weir
