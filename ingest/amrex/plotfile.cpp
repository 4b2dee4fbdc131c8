#include "ingest/amrex/plotfile.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/amrex/fab_header.h"
#include "ingest/files/input_directory.h"
#include "ingest/source/extent.h"
#include "ingest/vtk/file_text.h"

namespace weir {
namespace {

constexpr auto kMostVolume = static_cast<std::int64_t>(UINT64_C(1) << 60U);  // cells: their bytes are a 64-bit number

/// A header's file and the parser of its text.
struct HeaderFile {
  explicit HeaderFile(const std::string& path, Interruption interruption = nullptr)
      : file(path, DirectIo::off), pieces(file, 0, file.size()), text(path, [this, interruption] {
          throw_if_interrupted(interruption);
          return pieces.next_piece();
        }) {}

  InputFile file;
  FileText pieces;
  PlotfileText text;
};

void note(Plotfile& plotfile, const FileState& state) {
  plotfile.files.add(state);
  plotfile.bytes += state.bytes;
  plotfile.mtime_ns = std::max(plotfile.mtime_ns, state.mtime_ns);
}

std::string corner_text(const Index3& i) { return cat('(', i.x, ',', i.y, ',', i.z, ')'); }

/// Returns the box in the file's own indices, as its headers write it.
std::string shown(const Box& box) { return cat(corner_text(box.lo), " to ", corner_text(box.hi - Index3{1, 1, 1})); }

void move_to_domain(const std::string& path, const Box& domain, std::vector<CellBox>& boxes) {
  for (CellBox& box : boxes) {
    if (!domain.contains(box.box())) {
      throw input_error(path, cat("box ", shown(box.box()), " reaches outside the level's domain, ", shown(domain),
                                  "; the header is damaged"));
    }
    const Box moved{box.box().lo - domain.lo, box.box().hi - domain.lo};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto of = [axis](const Index3& i) {
        return static_cast<std::int32_t>(axis == 0 ? i.x : axis == 1 ? i.y : i.z);
      };
      box.lo.at(axis) = of(moved.lo);
      box.last.at(axis) = of(moved.hi - Index3{1, 1, 1});
    }
  }
}

void refuse_overlaps(const std::string& path, const PlotfileLevel& level, const Index3& first,
                     Interruption interruption) {
  const auto [a, b] = level.index.overlapping(interruption);
  if (a == b) return;
  const auto in_file = [&](std::uint32_t i) {
    const Box box = level.boxes[i].box();
    return shown({box.lo + first, box.hi + first});
  };
  throw input_error(path, cat("boxes ", a, " and ", b, ", ", in_file(a), " and ", in_file(b),
                              ", have cells in common; the header is damaged"));
}

void require_cover(const std::string& path, const PlotfileLevel& level) {
  std::uint64_t covered = 0;
  for (std::size_t i = 0; i < level.boxes.size(); ++i) covered += level.cells(i);
  const auto all = static_cast<std::uint64_t>(volume(level.extent));
  if (covered == all) return;
  throw input_error(path, cat("the boxes of level 0 cover ", covered, " of the ", all,
                              " cells of its domain, and must cover all; write the plotfile of the whole domain"));
}

/// Returns, for each file, the FAB that lies last in it.
std::vector<std::size_t> last_fabs(const PlotfileLevel& level) {
  std::vector<std::size_t> last(level.files.size(), SIZE_MAX);
  for (std::size_t i = 0; i < level.places.size(); ++i) {
    std::size_t& known = last[level.places[i].file];
    if (known == SIZE_MAX || level.places[i].offset > level.places[known].offset) known = i;
  }
  return last;
}

std::unique_ptr<InputFile> open_fab_file(const std::string& path, const std::string& header) {
  try {
    return std::make_unique<InputFile>(path, DirectIo::off);
  } catch (const Error& error) {
    throw Error(error.kind(), compose(error.message(), "; ", header, " has FABs in it"), error.system_failure());
  }
}

/// Returns the end of the values of a FAB that begin at `offset`; UINT64_MAX if it does not fit 64 bits.
std::uint64_t values_end(const Plotfile& plotfile, const PlotfileLevel& level, std::size_t fab, std::uint64_t offset) {
  const std::uint64_t components = plotfile.header.components.size();
  std::uint64_t end = 0;
  const bool fits = !__builtin_mul_overflow(level.cells(fab), components * scalar_bytes(plotfile.layout.type), &end) &&
                    !__builtin_add_overflow(end, offset, &end);
  return fits ? end : UINT64_MAX;
}

/// FABs without headers do not name their box, so bytes shared by two FABs can only be detected here.
void refuse_shared_bytes(const Plotfile& plotfile, const PlotfileLevel& level, const std::string& header) {
  const auto& places = level.places;
  std::vector<std::uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(places[a].file, places[a].offset) < std::tie(places[b].file, places[b].offset);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const FabPlace& place = places[order[i - 1]];
    const FabPlace& next = places[order[i]];
    if (place.file != next.file) continue;
    const std::uint64_t end = values_end(plotfile, level, order[i - 1], place.offset);
    if (end <= next.offset) continue;
    throw input_error(level.path(place.file),
                      cat("the FABs at offsets ", place.offset, " and ", next.offset,
                          " have bytes in common: the first ends at ", end, "; ", header, " is damaged"));
  }
}

/// Returns the file offset at which a FAB ends. Reads the FAB's header, if it has one, and sets plotfile.layout from it
/// for the `first` FAB.
std::uint64_t fab_end(InputFile& file, const PlotfileLevel& level, std::size_t fab, Plotfile& plotfile, bool first) {
  const std::uint64_t offset = level.places[fab].offset;
  if (level.bare) return values_end(plotfile, level, fab, offset);
  const FabHeader header = read_fab_header(file, offset);
  if (first) plotfile.layout = header.layout;
  return values_end(plotfile, level, fab, offset + header.bytes);
}

void check_fab_files(Plotfile& plotfile, const PlotfileLevel& level, const std::string& header, bool first,
                     Interruption interruption) {
  const std::vector<std::size_t> last = last_fabs(level);
  for (std::uint32_t i = 0; i < level.files.size(); ++i) {
    throw_if_interrupted(interruption);
    const auto file = open_fab_file(level.path(i), header);
    note(plotfile, file->state());
    const std::uint64_t offset = level.places[last[i]].offset;
    const std::uint64_t end =
        offset < file->size() ? fab_end(*file, level, last[i], plotfile, std::exchange(first, false)) : offset + 1;
    if (end <= file->size()) continue;
    throw input_error(file->path(), cat("has ", file->size(), " bytes, and the FAB at offset ", offset, " ends at ",
                                        end, "; the file is cut, or not written to its end"));
  }
}

PlotfileLevel open_level(Plotfile& plotfile, std::size_t number, std::uint64_t memory, const PlotfileParts& parts) {
  const AmrexLevelHeader& said = plotfile.header.levels[number];
  const std::string path = cell_header_path(plotfile, number);
  HeaderFile file(path, parts.interruption);
  note(plotfile, file.file.state());
  CellHeader cells = parse_cell_header(file.text, file.file.size(), memory, parts.ranges);
  if (std::cmp_not_equal(cells.components, plotfile.header.components.size())) {
    throw input_error(path, cat("has ", cells.components, " components, and Header has ",
                                plotfile.header.components.size(), "; the plotfile is damaged"));
  }
  if (std::cmp_not_equal(cells.boxes.size(), said.boxes)) {
    throw input_error(
        path, cat("has ", cells.boxes.size(), " boxes, and Header has ", said.boxes, "; the plotfile is damaged"));
  }
  move_to_domain(path, said.domain, cells.boxes);
  PlotfileLevel level;
  level.extent = said.domain.extent();
  level.ratio = said.ratio;
  level.directory = std::filesystem::path(path).parent_path().string();
  level.boxes = std::move(cells.boxes);
  level.places = std::move(cells.places);
  level.files = std::move(cells.files);
  level.ranges = std::move(cells.ranges);
  level.box_ranges = std::move(cells.box_ranges);
  level.bare = cells.layout.has_value();
  if (cells.layout && number > 0 && *cells.layout != plotfile.layout) {
    throw input_error(path, cat("its numbers are ", real_layout_text(*cells.layout), ", and those of level 0 ",
                                real_layout_text(plotfile.layout), "; all must be alike"));
  }
  if (cells.layout) plotfile.layout = *cells.layout;
  if (level.bare) refuse_shared_bytes(plotfile, level, path);
  level.index = BoxIndex(level.boxes);
  refuse_overlaps(path, level, said.domain.lo, parts.interruption);
  if (number == 0) require_cover(path, level);
  check_fab_files(plotfile, level, path, number == 0, parts.interruption);
  return level;
}

}  // namespace

std::string plotfile_directory(const std::string& path) {
  const std::filesystem::path named(path);
  if (named.filename() != kDirectoryHead || is_input_directory(path)) return path;
  return named.has_parent_path() ? named.parent_path().string() : ".";
}

std::string box_in_file(const Plotfile& plotfile, std::size_t level, std::uint32_t box) {
  const Index3 first = plotfile.header.levels[level].domain.lo;
  const Box cells = plotfile.levels[level].boxes[box].box();
  return shown({cells.lo + first, cells.hi + first});
}

std::string cell_header_path(const Plotfile& plotfile, std::size_t level) {
  return cat(plotfile_directory(plotfile.path), '/', plotfile.header.levels[level].cells, "_H");
}

AmrexHeader read_amrex_header(const std::string& path, Interruption interruption) {
  HeaderFile file(cat(plotfile_directory(path), '/', kDirectoryHead), interruption);
  return parse_amrex_header(file.text);
}

Plotfile open_plotfile(const std::string& path, const PlotfileParts& parts) {
  Plotfile plotfile;
  plotfile.path = path;
  {
    HeaderFile file(cat(plotfile_directory(path), '/', kDirectoryHead), parts.interruption);
    note(plotfile, file.file.state());
    plotfile.header = parse_amrex_header(file.text);
    for (const AmrexLevelHeader& level : plotfile.header.levels) {
      const Index3 e = level.domain.extent();
      std::int64_t cells = 0;
      if (__builtin_mul_overflow(e.x, e.y, &cells) || __builtin_mul_overflow(cells, e.z, &cells) ||
          cells > kMostVolume) {
        throw file.text.error(cat("a domain of ", extent_text(e), " cells is impossible; the header is damaged"));
      }
    }
  }
  const std::size_t levels = std::min(parts.levels, plotfile.header.levels.size());
  std::uint64_t memory = parts.memory;
  for (std::size_t i = 0; i < levels; ++i) {
    plotfile.levels.push_back(open_level(plotfile, i, memory, parts));
    memory -= std::min(memory, plotfile.levels.back().boxes.size() * kBytesPerBox);
  }
  return plotfile;
}

}  // namespace weir
