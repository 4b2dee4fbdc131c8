// Runs a program in several processes of MPI.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir {

// Of a launcher that refuses root and more processes than cores unless told.
inline CommandOptions mpi_options(const std::filesystem::path& directory) {
  CommandOptions options;
  options.directory = directory;
  options.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                         "OMPI_MCA_rmaps_base_oversubscribe=1", "OMPI_MCA_mpi_yield_when_idle=1",
                         "OMPI_MCA_btl_base_warn_component_unused=0"};
  return options;
}

inline CommandResult run_mpi(int processes, std::vector<std::string> command, const std::filesystem::path& directory) {
  command.insert(command.begin(), {WEIR_MPIEXEC, "-n", cat(processes)});
  return run_command(command, mpi_options(directory));
}

// The first line that `program` said, among those of the launcher.
inline std::string line_of(const std::string& text, const std::string& program) {
  const std::size_t at = text.find(program + ": ");
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

}  // namespace weir
