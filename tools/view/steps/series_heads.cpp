#include "tools/view/steps/series_heads.h"

#include "format/base/error.h"
#include "tools/view/base/file_identity.h"

namespace weir {

bool SeriesHeads::look_at(const std::string& path) {
  const std::string identity = file_identity(path);  // before reading: a file that replaces it has another identity
  const auto known = read_.find(path);
  if (known != read_.end() && known->second == identity) return true;
  try {
    add_to_summary(summary_, path);
  } catch (const Error&) {  // reported when the file is shown
    return false;
  }
  read_[path] = identity;
  return true;
}

}  // namespace weir
