#include "format/sidecar/is_of.h"

#include <string>

#include "format/io/digest.h"
#include "format/io/output_names.h"
#include "format/io/real_path.h"
#include "format/sidecar/find_sidecar.h"

namespace weir {
namespace {

// Of a commit that was killed, or is under way, beside the file that `path` leads to.
bool has_trace_of_commit(const std::string& path) {
  const std::string sidecar = find_sidecar(path);
  const std::string volume = sidecar.substr(0, sidecar.size() - kSidecarEnding.size());
  return is_there(previous_path(sidecar)) || is_there(partial_path(volume));
}

}  // namespace

bool is_of(const Sidecar& sidecar, const NvdbGrid& grid) {
  if (sidecar.file.bytes != grid.bytes().size() || sidecar.file.head_checksum != grid.head_checksum()) return false;
  return !has_trace_of_commit(grid.path()) || whole_digest(grid.bytes()).hex() == sidecar.file.digest;
}

}  // namespace weir
