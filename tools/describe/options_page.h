// docs/options.md: the options of a conversion in the names of every front end.
#pragma once

#include <string>

namespace weir {

/// Markdown, made from the tables of compressor/options.
std::string options_page();

}  // namespace weir
