// SIGINT, SIGTERM and SIGHUP as a request to stop, which work checks.
#pragma once

#include "format/base/error.h"

namespace weir {

/// From here on the first of the signals sets interrupt_flag (command.h), so that the work ends cleanly; a second one
/// ends the process at once. A SIGHUP that is ignored (nohup) stays so. A write beyond the limit of file size is an
/// error of the call from here on, and no signal.
void catch_interrupts();

/// What the process exits with: where it was interrupted, 129 after SIGHUP, else what the error says.
int exit_code_of(const Error& error);

}  // namespace weir
