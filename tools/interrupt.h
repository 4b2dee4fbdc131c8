// SIGINT, SIGTERM and SIGHUP, as a wish that work looks at.
#pragma once

namespace weir {

/// From here on the first of the signals sets interrupt_flag (command.h), so that the work ends cleanly; a second one
/// ends the process at once. A SIGHUP that is ignored (nohup) stays so. What a limit of file size stops is an error of
/// the writing call from here on, and no signal.
void catch_interrupts();

/// What the process exits with where it was interrupted: 129 after SIGHUP, else 130.
int interrupted_exit_code();

}  // namespace weir
