// libFuzzer target for the headers of AMReX plotfiles. The first byte selects the kind of header and, for Header and
// Cell_H, the size of the pieces in which the text arrives; a FAB header is parsed whole. Any bytes must parse to a
// header with consistent parts, or throw Error(input) with a message of one line.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "ingest/amrex/amrex_header.h"
#include "ingest/amrex/box_index.h"
#include "ingest/amrex/cell_header.h"
#include "ingest/amrex/fab_header.h"

namespace {

weir::PlotfileText text_of(std::string_view& rest, std::size_t piece) {
  return {"fuzz", [&rest, piece] {
            const std::string_view next = rest.substr(0, piece);
            rest.remove_prefix(next.size());
            return next;
          }};
}

void check_header(std::string_view input, std::size_t piece) {
  weir::PlotfileText text = text_of(input, piece);
  const weir::AmrexHeader header = weir::parse_amrex_header(text);
  if (header.components.empty() || header.levels.empty()) std::abort();
  weir::Index3 extent = header.levels.front().domain.extent();
  for (const weir::AmrexLevelHeader& level : header.levels) {
    extent = {extent.x * level.ratio.x, extent.y * level.ratio.y, extent.z * level.ratio.z};
    if (level.domain.empty() || level.domain.extent() != extent || level.boxes < 1) std::abort();
    for (const double s : level.spacing) {
      if (!(s > 0)) std::abort();
    }
    if (level.cells.empty() || level.cells.front() == '/') std::abort();
  }
}

void check_cells(std::string_view input, std::size_t piece) {
  const std::size_t size = input.size();
  weir::PlotfileText text = text_of(input, piece);
  const weir::CellHeader header =
      weir::parse_cell_header(text, size, UINT64_MAX, {.of_components = true, .of_boxes = 0});
  if (header.boxes.empty() || header.places.size() != header.boxes.size()) std::abort();
  if (!header.ranges.empty() && header.ranges.size() != static_cast<std::size_t>(header.components)) std::abort();
  for (const weir::FabPlace& place : header.places) {
    if (place.file >= header.files.size()) std::abort();
  }
  const weir::BoxIndex index(header.boxes);
  for (std::uint32_t i = 0; i < header.boxes.size(); ++i) {
    std::vector<std::uint32_t> found;
    index.find(header.boxes[i].box(), found);
    if (std::find(found.begin(), found.end(), i) == found.end()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view input(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t piece = 1 + data[0] / 3U;
  try {
    switch (data[0] % 3) {
      case 0:
        check_header(input, piece);
        break;
      case 1:
        check_cells(input, piece);
        break;
      default:
        if (weir::parse_fab_header(input, "fuzz", 0).bytes > input.size()) std::abort();
    }
  } catch (const weir::Error& error) {
    const std::string_view message = error.what();
    if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
