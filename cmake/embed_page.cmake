# cmake -D PAGE=<folder> -D FUNCTION=<name> -D HEADER=<path> -D OUTPUT=<file> -P embed_page.cmake
# Writes the files of PAGE into the C++ source OUTPUT, which defines FUNCTION() of HEADER: PageFile of
# daemon/http/page_files.h.

file(GLOB paths ${PAGE}/*)
list(SORT paths)
set(source "// Written by cmake/embed_page.cmake from a folder of page files.\n#include \"${HEADER}\"\n\n#include <array>\n\n")
string(APPEND source "namespace weir {\n\nstd::span<const PageFile> ${FUNCTION}() {\n  static constexpr auto kFiles = std::to_array<PageFile>({\n")
foreach(path IN LISTS paths)
  get_filename_component(name ${path} NAME)
  file(READ ${path} content)
  string(APPEND source "      {\"${name}\", R\"page(${content})page\"},\n")
endforeach()
string(APPEND source "  });\n  return kFiles;\n}\n\n}  // namespace weir\n")
file(WRITE ${OUTPUT} "${source}")
