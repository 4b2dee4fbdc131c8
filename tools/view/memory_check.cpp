#include "tools/view/memory_check.h"

#include <optional>
#include <string>

#include "format/base/error.h"
#include "format/nanovdb/nvdb_file.h"

namespace weir {
namespace {

using Naming = std::function<std::string(const std::string& path)>;

void require_memory_of(const std::string& path, const VoxelMemory& memory, const Naming& named) {
  const NvdbFile file(path);
  try {
    plan_voxels(file.grid(), memory);
  } catch (const Error& error) {
    // An error of another kind says that the machine has too little memory now; that may change before a picture is
    // asked for.
    if (error.kind() == ErrorKind::usage) throw usage_error(compose(named(path), ": ", error.message()));
  }
}

}  // namespace

void require_memory(const ViewedFiles& files, const VoxelMemory& memory, const Naming& named) {
  if (!memory.ceiling) return;
  if (files.against.size() == 1) require_memory_of(files.against.front(), memory, named);
  std::optional<Error> first;
  for (const std::string& step : files.steps) {
    try {
      return require_memory_of(step, memory, named);
    } catch (const Error& error) {
      if (!first && error.kind() == ErrorKind::usage) first = error;
    }
  }
  if (first) throw Error(*first);
}

}  // namespace weir
