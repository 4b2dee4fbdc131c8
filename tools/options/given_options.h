// The options of a command line, as the sidecar's weir.options records them.
#pragma once

#include <map>
#include <string>

#include "format/base/option_row.h"

namespace CLI {
class App;
}

namespace weir {

/// Returns every option of `command` that was given and affects what is written, by its long name; a flag is "true".
/// Options of an option table are taken from `read`, which holds their parsed text.
std::map<std::string, std::string> given_options(const CLI::App& command, const GivenOptions& read);
/// Returns the options of `given` that affect what is written.
std::map<std::string, std::string> recorded_options(const GivenOptions& given);

}  // namespace weir
