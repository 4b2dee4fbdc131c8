#include "daemon/jobs/wrong_output.h"

#include <memory>

#include "daemon/store/file_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/output/output_place.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

// Must be called under the lock. Removes the volume first: a sidecar alone is no result, and if the volume stays, its
// sidecar must stay, too.
std::string remove_both(FileSystem& files, const std::string& output) {
  const std::string sidecar = sidecar_path(output);
  try {
    files.remove(output);
  } catch (const Error& error) {
    return cat("not removed: ", error.what(), "; remove it and ", sidecar);
  }
  try {
    files.remove(sidecar);
  } catch (const Error& error) {
    return cat("not removed: its sidecar, ", error.what(), "; remove ", sidecar, " before the next attempt");
  }
  try {
    files.sync_directory(directory_of(output));
  } catch (const Error& error) {
    return cat("removed, which a crash may undo: ", error.what(), "; check the disk");
  }
  return "removed";
}

}  // namespace

std::string remove_wrong_output(FileSystem& files, const std::string& output,
                                const std::optional<FileIdentity>& verified) {
  const std::string lock_path = partial_path(output);
  const bool was_there = files.exists(lock_path);
  std::string outcome;
  try {
    const std::unique_ptr<File> lock = files.open(lock_path);
    require_alone(*lock);
    outcome =
        identify(output) == verified
            ? remove_both(files, output)
            : cat("not removed: ", output, " was replaced or written to since; the next attempt verifies it again");
    if (!was_there) files.remove(lock_path);
  } catch (const Error& error) {
    // If only the removal of the lock's file fails, nothing is said: the file does no harm, and the next conversion
    // takes it over.
    if (outcome.empty()) outcome = cat("not removed: ", error.what());
  }
  return outcome;
}

}  // namespace weir
