// SIGINT and SIGTERM, as a wish that work looks at.
#pragma once

namespace weir {

/// From here on the first of the signals sets interrupt_flag (command.h), so that the work ends cleanly; a second one
/// ends the process at once.
void catch_interrupts();

}  // namespace weir
