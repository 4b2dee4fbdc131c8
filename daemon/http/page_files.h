// The files of daemon/page/, compiled into the program (cmake/embed_page.cmake).
#pragma once

#include <span>
#include <string_view>

namespace weir {

struct PageFile {
  std::string_view name;  ///< "index.html"
  std::string_view content;
};

std::span<const PageFile> page_files();

}  // namespace weir
