#include "compressor/build_commit.h"

namespace weir {

std::string build_commit() { return WEIR_COMMIT; }

}  // namespace weir
