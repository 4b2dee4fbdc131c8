// What a command line said, for the sidecar's weir.options.
#pragma once

#include <map>
#include <string>

#include "format/base/option_row.h"

namespace CLI {
class App;
}

namespace weir {

/// Every option of `command` that was given and has a say in what is written, by its long name; a flag is "true".
/// Of those in a table, `read` counts, which is what was made of them.
std::map<std::string, std::string> given_options(const CLI::App& command, const GivenOptions& read);
/// The same of options that were given otherwise.
std::map<std::string, std::string> recorded_options(const GivenOptions& given);

}  // namespace weir
