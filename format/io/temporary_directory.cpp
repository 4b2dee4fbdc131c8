#include "format/io/temporary_directory.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

std::string temporary_directory() {
  std::error_code failure;
  const std::filesystem::path found = std::filesystem::temp_directory_path(failure);
  if (!failure) return found.string();
  const char* const named = std::getenv("TMPDIR");
  throw Error(ErrorKind::io, cat(named != nullptr ? named : "/tmp",
                                 ": is no directory for temporary files; make it, or set TMPDIR to another one"));
}

}  // namespace weir
