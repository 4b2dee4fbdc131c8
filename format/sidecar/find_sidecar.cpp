#include "format/sidecar/find_sidecar.h"

#include <filesystem>
#include <system_error>

#include "format/io/real_path.h"
#include "format/sidecar/sidecar.h"

namespace weir {

std::string find_sidecar(const std::string& volume_path) {
  std::string beside = sidecar_path(volume_path);
  std::error_code ignored;
  if (is_there(beside) || !std::filesystem::is_symlink(volume_path, ignored)) return beside;
  std::string led_to = sidecar_path(real_path(volume_path).string());
  return is_there(led_to) ? led_to : beside;
}

}  // namespace weir
