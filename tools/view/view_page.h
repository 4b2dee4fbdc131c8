// The files of tools/view/page/, compiled into the program (cmake/embed_page.cmake). Those that it shares with the page
// of the daemon are daemon/page/'s.
#pragma once

#include <span>

#include "daemon/http/page_files.h"

namespace weir {

std::span<const PageFile> view_page_files();

}  // namespace weir
