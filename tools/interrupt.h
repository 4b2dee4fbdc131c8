// Turns SIGINT, SIGTERM and SIGHUP into a stop request, a flag that the work checks.
#pragma once

#include "format/base/error.h"

namespace weir {

/// Installs the signal handlers. The first signal sets interrupt_flag (command.h), so that the work ends cleanly. A
/// second signal ends the process at once. A SIGHUP that is ignored (nohup) stays ignored. A write beyond the file
/// size limit then fails as an error of the call and raises no signal.
void catch_interrupts();

/// Returns the exit code for `error`: 129 if SIGHUP interrupted the process, otherwise the code of the error.
int exit_code_of(const Error& error);

}  // namespace weir
