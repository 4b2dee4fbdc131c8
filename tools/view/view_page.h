// The files of tools/view/page/, compiled into the program (cmake/embed_page.cmake). Files shared with the daemon's
// page come from daemon/page/.
#pragma once

#include <span>

#include "daemon/http/page_files.h"

namespace weir {

std::span<const PageFile> view_page_files();

}  // namespace weir
