// Writes docs/options.md: the options of a conversion, by their names in every front end.
#pragma once

#include <string>

namespace weir {

/// Returns the page in Markdown, made from the tables of compressor/options.
std::string options_page();

}  // namespace weir
