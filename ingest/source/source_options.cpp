#include "ingest/source/source_options.h"

#include "format/base/error.h"

namespace weir {

void refuse_index(const std::string& path, const SourceOptions& options) {
  if (options.index.empty()) return;
  throw usage_error(compose(path, ": ", option("index"), " is for arrays of more than three axes; leave it out"));
}

}  // namespace weir
