// The manual of a command, for man(1).
#pragma once

#include <string>
#include <vector>

#include "tools/describe/command_description.h"

namespace weir {

/// "weir" or "weir-convert": the page is this and ".1".
std::string man_page_name(const CommandDescription& command);

/// The page of `command` in the language of man(7), one of `all`, of which the first is weir itself.
std::string man_page(const CommandDescription& command, const std::vector<CommandDescription>& all,
                     const std::string& version);

}  // namespace weir
