// Writes the manual page of a command, for man(1).
#pragma once

#include <string>
#include <vector>

#include "tools/describe/command_description.h"

namespace weir {

/// Returns "weir" or "weir-convert"; the page's file is this name and ".1".
std::string man_page_name(const CommandDescription& command);

/// Returns the page of `command` in the language of man(7). `command` is one of `all`; the first of `all` is weir
/// itself.
std::string man_page(const CommandDescription& command, const std::vector<CommandDescription>& all,
                     const std::string& version);

}  // namespace weir
