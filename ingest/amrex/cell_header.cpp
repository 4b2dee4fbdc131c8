#include "ingest/amrex/cell_header.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::uint64_t kLeastBytesPerBox = 40;  // "((0,0,0) (0,0,0) (0,0,0))" and "FabOnDisk: C 0", with line ends

// How the FABs are stored: VisMF::Header::Version.
enum class Version { plain = 1, bare = 2, bare_with_ranges = 3, bare_with_range = 4 };

std::string in_brackets(const Index3& i) { return cat('(', i.x, ',', i.y, ',', i.z, ')'); }

void refuse_ghost_cells(PlotfileText& text) {
  Index3 layers;
  if (text.next_byte() == '(') {
    layers = text.vector("the layers of ghost cells");
  } else {
    const std::int64_t all = text.integer("the layers of ghost cells");
    layers = {all, all, all};
  }
  if (layers == Index3{}) return;
  throw text.unsupported(cat("the boxes have ", in_brackets(layers),
                             " layers of ghost cells, which cannot be read; write the plotfile without them"));
}

CellBox packed_box(const Box& box) {
  const auto narrow = [](std::int64_t i) { return static_cast<std::int32_t>(i); };
  return {{narrow(box.lo.x), narrow(box.lo.y), narrow(box.lo.z)},
          {narrow(box.hi.x - 1), narrow(box.hi.y - 1), narrow(box.hi.z - 1)}};
}

// Reads "(N 0", N boxes, and ")".
void read_boxes(PlotfileText& text, std::uint64_t bytes, std::uint64_t memory, CellHeader& header) {
  text.expect('(', "the list of boxes");
  const std::int64_t count = text.integer("the number of boxes");
  if (count < 1 || static_cast<std::uint64_t>(count) > bytes / kLeastBytesPerBox) {
    throw text.error(cat(count, " boxes are said to follow, and the file of ", bytes, " bytes can hold 1 to ",
                         bytes / kLeastBytesPerBox, "; it is cut or damaged"));
  }
  const std::uint64_t needed = static_cast<std::uint64_t>(count) * kBytesPerBox;
  if (needed > memory) {
    throw usage_error(compose(text.path(), ": its ", count, " boxes take ", format_bytes(needed),
                              ", more than a quarter of ", option("memory"), "; give at least ",
                              (4 * needed >> 20U) + 1, "MiB"));
  }
  text.skip_word("the hash of the boxes");
  header.boxes.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) header.boxes.push_back(packed_box(text.box("a box")));
  text.expect(')', "the list of boxes");
}

void read_places(PlotfileText& text, CellHeader& header) {
  const auto boxes = static_cast<std::int64_t>(header.boxes.size());
  const std::int64_t count = text.integer("the number of FABs");
  if (count != boxes) throw text.error(cat(count, " FABs for ", boxes, " boxes; the header is damaged"));
  std::map<std::string, std::uint32_t, std::less<>> known;
  header.places.reserve(header.boxes.size());
  for (std::int64_t i = 0; i < count; ++i) {
    if (const std::string_view mark = text.word("FabOnDisk:"); mark != "FabOnDisk:") {
      throw text.error(cat(in_quotes(mark), " should be FabOnDisk:"));
    }
    const std::string_view name = text.word("the name of a FAB's file");
    auto at = known.find(name);
    if (at == known.end()) {
      const bool beside = name.find('/') == std::string_view::npos && name != "." && name != "..";
      const bool plain = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; });
      if (!beside || !plain) {
        throw text.error(cat(in_quotes(name), " should be the name of a file beside Cell_H; the header is damaged"));
      }
      at = known.emplace(std::string(name), static_cast<std::uint32_t>(header.files.size())).first;
      header.files.emplace_back(name);
    }
    const std::int64_t offset = text.integer("the offset of a FAB");
    if (offset < 0) throw text.error(cat("a FAB at offset ", offset, " is impossible; the header is damaged"));
    header.places.push_back({static_cast<std::uint64_t>(offset), at->second});
  }
}

// Reads "N,M" and then N times M numbers, each followed by a comma. Passes each with its box and component to `take`.
template <typename Take>
void read_table(PlotfileText& text, const CellHeader& header, const Take& take) {
  constexpr std::string_view kWhat = "the table of the boxes' minima and maxima";
  const std::int64_t rows = text.integer(kWhat, ",");
  text.expect(',', kWhat);
  const std::int64_t columns = text.integer(kWhat, ",");
  if (std::cmp_not_equal(rows, header.boxes.size()) || columns != header.components) {
    throw text.error(cat(kWhat, " has ", rows, " rows of ", columns, ", and there are ", header.boxes.size(),
                         " boxes and ", header.components, " components; the header is damaged"));
  }
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t column = 0; column < columns; ++column) {
      take(static_cast<std::size_t>(row), static_cast<std::size_t>(column), text.real("a minimum or maximum", ","));
      text.expect(',', kWhat);
    }
  }
}

void read_range_tables(PlotfileText& text, CellHeader& header, const RangesKept& kept) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<ComponentRange> ranges;
  std::vector<ComponentRange> of_boxes;
  if (kept.of_components) ranges.resize(static_cast<std::size_t>(header.components), {kInfinity, -kInfinity});
  if (kept.of_boxes) of_boxes.resize(header.boxes.size());
  // A NaN does not change a component's range, because comparisons with it are false.
  read_table(text, header, [&](std::size_t box, std::size_t c, double value) {
    if (kept.of_components) ranges[c].min = std::min(ranges[c].min, value);
    if (kept.of_boxes == c) of_boxes[box].min = value;
  });
  read_table(text, header, [&](std::size_t box, std::size_t c, double value) {
    if (kept.of_components) ranges[c].max = std::max(ranges[c].max, value);
    if (kept.of_boxes == c) of_boxes[box].max = value;
  });
  header.ranges = std::move(ranges);
  header.box_ranges = std::move(of_boxes);
}

void read_range_rows(PlotfileText& text, CellHeader& header, const RangesKept& kept) {
  std::vector<ComponentRange> ranges(static_cast<std::size_t>(header.components));
  const auto read_row = [&](double ComponentRange::*end) {
    for (ComponentRange& range : ranges) {
      range.*end = text.real("a minimum or maximum", ",");
      text.expect(',', "a row of minima or maxima");
    }
  };
  read_row(&ComponentRange::min);
  read_row(&ComponentRange::max);
  if (kept.of_boxes && *kept.of_boxes < ranges.size()) {
    header.box_ranges.assign(header.boxes.size(), ranges[*kept.of_boxes]);
  }
  if (kept.of_components) header.ranges = std::move(ranges);
}

}  // namespace

CellHeader parse_cell_header(PlotfileText& text, std::uint64_t bytes, std::uint64_t memory, const RangesKept& kept) {
  CellHeader header;
  const auto version = static_cast<Version>(text.integer_in("the version", 1, 4));
  text.integer_in("the way of writing", 0, 1);
  header.components = text.integer_in("the number of components", 1, kMostAmrexComponents);
  refuse_ghost_cells(text);
  read_boxes(text, bytes, memory, header);
  read_places(text, header);
  if (version == Version::plain || version == Version::bare_with_ranges) read_range_tables(text, header, kept);
  if (version == Version::bare_with_range) read_range_rows(text, header, kept);
  if (version != Version::plain) header.layout = parse_real_layout(text);
  return header;
}

}  // namespace weir
