#include "ingest/amrex/fab_header.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {

FabHeader parse_fab_header(std::string_view head, const std::string& path, std::uint64_t offset) {
  const std::string where = cat(path, ": offset ", offset);
  const std::size_t end = head.find('\n');
  const std::string_view line = head.substr(0, end);
  if (line.starts_with("FAB:")) {
    throw Error(ErrorKind::input, cat(where, ": ", in_quotes(line),
                                      " is a FAB in the format before AMReX, which cannot be read; write it anew"));
  }
  if (!line.starts_with("FAB ") || end == std::string_view::npos) {
    throw Error(ErrorKind::input, cat(where, ": ", in_quotes(line),
                                      " should be the header of a FAB; Cell_H is of other "
                                      "files, or these are damaged"));
  }
  std::string_view rest = line.substr(4);
  PlotfileText text(where, [&] { return std::exchange(rest, {}); });
  FabHeader header;
  header.layout = parse_real_layout(text);
  header.box = text.box("a FAB's box");
  header.components = text.integer("a FAB's number of components");
  header.bytes = end + 1;
  return header;
}

FabHeader read_fab_header(InputFile& file, std::uint64_t offset) {
  std::array<char, kMostFabHeaderBytes> bytes{};
  const auto head = std::span(bytes).first(std::min<std::uint64_t>(bytes.size(), file.size() - offset));
  file.read_buffered(offset, std::as_writable_bytes(head), ReadPath::through);
  return parse_fab_header({head.data(), head.size()}, file.path(), offset);
}

}  // namespace weir
