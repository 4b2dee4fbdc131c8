#include "ingest/amrex/fab_files.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/amrex/fab_header.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

constexpr std::uint16_t kUnknown = UINT16_MAX;

}  // namespace

FabFiles::FabFiles(const Plotfile& plotfile, DirectIo mode) : plotfile_(plotfile), mode_(mode) {
  for (const PlotfileLevel& level : plotfile.levels) {
    header_bytes_.emplace_back(level.boxes.size());
    for (auto& bytes : header_bytes_.back()) bytes = kUnknown;
  }
}

std::shared_ptr<InputFile> FabFiles::file_of(std::size_t level, std::uint32_t fab) {
  const PlotfileLevel& of = plotfile_.levels[level];
  const std::uint32_t number = of.places[fab].file;
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(open_.begin(), open_.end(), [&](const OpenFile& o) { return o.level == level && o.file == number; });
  if (found != open_.end()) {
    open_.splice(open_.begin(), open_, found);
    return found->input;
  }
  // The last reader of a file closes it. Its bytes are counted then.
  std::shared_ptr<InputFile> input(std::make_unique<InputFile>(of.path(number), mode_).release(),
                                   [closed = closed_bytes_](InputFile* closing) {
                                     const std::unique_ptr<InputFile> owned(closing);
                                     *closed += owned->bytes_read();
                                   });
  open_.push_front({level, number, input});
  if (open_.size() > kOpenFiles) open_.pop_back();
  return input;
}

std::uint64_t FabFiles::values_offset(std::size_t level, std::uint32_t fab, InputFile& file) {
  std::atomic<std::uint16_t>& bytes = header_bytes_[level][fab];
  if (bytes == kUnknown) bytes = checked_header(level, fab, file);
  return plotfile_.levels[level].places[fab].offset + bytes;
}

std::uint16_t FabFiles::checked_header(std::size_t number, std::uint32_t fab, InputFile& file) const {
  const PlotfileLevel& level = plotfile_.levels[number];
  const std::uint64_t offset = level.places[fab].offset;
  const auto components = static_cast<std::int64_t>(plotfile_.header.components.size());
  std::uint64_t header_bytes = 0;
  if (!level.bare && offset < file.size()) {
    const FabHeader header = read_fab_header(file, offset);
    const Index3 lo = plotfile_.header.levels[number].domain.lo;
    const Box box = level.boxes[fab].box();
    const Box expected{box.lo + lo, box.hi + lo};
    if (header.box != expected || header.components != components || header.layout != plotfile_.layout) {
      const auto text = [](const Box& b, std::int64_t n, const RealLayout& layout) {
        return cat(n, " components of ", real_layout_text(layout), " in ", box_text(b));
      };
      throw input_error(file.path(),
                        cat("offset ", offset, ": a FAB of ", text(header.box, header.components, header.layout),
                            ", and ", text(expected, components, plotfile_.layout),
                            " belong there; Cell_H is of other files, or these are damaged"));
    }
    header_bytes = header.bytes;
  }
  // The products do not overflow: the domain and the components were checked when the plotfile was opened.
  const std::uint64_t values =
      level.cells(fab) * static_cast<std::uint64_t>(components) * scalar_bytes(plotfile_.layout.type);
  if (offset + header_bytes + values > file.size()) {
    throw input_error(file.path(), cat("has ", file.size(), " bytes, and the FAB at offset ", offset, " ends at ",
                                       offset + header_bytes + values, "; the file is cut"));
  }
  return static_cast<std::uint16_t>(header_bytes);
}

std::uint64_t FabFiles::bytes_read() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t bytes = closed_bytes_->load();
  for (const OpenFile& file : open_) bytes += file.input->bytes_read();
  return bytes;
}

}  // namespace weir
