#include "ingest/hdf5/virtual/virtual_boxes.h"

#include <algorithm>
#include <list>
#include <utility>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/hdf5/storage/storage.h"
#include "ingest/hdf5/virtual/library_boxes.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

constexpr std::size_t kOpenSources = 4;           // files open at a time: there may be thousands of them
constexpr std::uint64_t kBytesPerMapping = 4096;  // two selections and two names, about
constexpr std::uint64_t kSourceChunkCopies = 2;   // before and after a filter

// Returns the dataset's elements for a box at a position of the leading axes.
AxisBox axis_box(const std::vector<std::int64_t>& index, const Box& box, std::int64_t components) {
  AxisBox placed;
  for (const std::int64_t i : index) {
    placed.lo.push_back(static_cast<hsize_t>(i));
    placed.hi.push_back(static_cast<hsize_t>(i) + 1);
  }
  for (const std::int64_t lo : {box.lo.z, box.lo.y, box.lo.x}) placed.lo.push_back(static_cast<hsize_t>(lo));
  for (const std::int64_t hi : {box.hi.z, box.hi.y, box.hi.x}) placed.hi.push_back(static_cast<hsize_t>(hi));
  if (components > 1) {
    placed.lo.push_back(0);
    placed.hi.push_back(static_cast<hsize_t>(components));
  }
  return placed;
}

bool overlap(const AxisBox& a, const AxisBox& b) {
  for (std::size_t i = 0; i < a.lo.size(); ++i) {
    if (a.lo[i] >= b.hi[i] || b.lo[i] >= a.hi[i]) return false;
  }
  return true;
}

class VirtualBoxes final : public StoredBoxes {
 public:
  VirtualBoxes(Hdf5Handle dataset, std::vector<std::int64_t> index, const WantedVoxels& wanted, std::int64_t components,
               const std::string& parent, std::string where)
      : dataset_(std::move(dataset)),
        index_(std::move(index)),
        components_(components),
        where_(std::move(where)),
        crash_line_(hdf5_crash_line(where_)),
        type_(H5Dget_type(dataset_.get())),
        space_(H5Dget_space(dataset_.get())),
        mapped_(virtual_mappings(dataset_.get(), {axis_box(index_, wanted.box, components_), wanted.need_a_source},
                                 parent, where_)) {
    // If a source's fill time is "never", the library leaves the memory of unwritten elements as it is.
    if (mapped_.unmapped.count > 0 || mapped_.unwritten.count > 0) fill_ = storage_of(dataset_.get()).fill;
    for (const VirtualMapping& mapping : mapped_.mappings) {
      if (mapping.chunk.empty()) continue;
      std::uint64_t bytes = kSourceChunkCopies * mapping.value_bytes;
      for (const hsize_t elements : mapping.chunk) bytes *= elements;  // the library checks: below 2^32
      chunk_bytes_ = std::max(chunk_bytes_, bytes);
    }
    // Sources usually have the same chunks, so the chunks of the first source serve for all.
    if (mapped_.mappings.empty() || mapped_.mappings[0].chunk.empty()) return;
    const AxisBox& bounds = mapped_.mappings[0].bounds;
    const std::size_t rank = bounds.lo.size();
    const auto at = [&](std::size_t from_end) {
      const std::vector<hsize_t>& chunk = mapped_.mappings[0].chunk;
      const hsize_t wide = bounds.hi[rank - from_end] - bounds.lo[rank - from_end];
      return static_cast<std::int64_t>(
          from_end > chunk.size() ? 1 : std::min<hsize_t>(chunk[chunk.size() - from_end], wide));
    };
    const auto corner = [&](std::size_t from_end) { return static_cast<std::int64_t>(bounds.lo[rank - from_end]); };
    const std::size_t x = components_ > 1 ? 2 : 1;
    chunk_ = {at(x), at(x + 1), at(x + 2)};
    chunk_origin_ = {corner(x), corner(x + 1), corner(x + 2)};
  }

  const Uncovered& unmapped() const { return mapped_.unmapped; }
  const UnwrittenInSources& unwritten() const { return mapped_.unwritten; }
  Index3 chunk() const override { return chunk_; }
  Index3 chunk_origin() const override { return chunk_origin_; }
  std::vector<std::string> files() const override {
    std::vector<std::string> files;
    for (const VirtualMapping& mapping : mapped_.mappings) files.push_back(mapping.file);
    return files;
  }
  std::uint64_t working_bytes() const override {
    return chunk_bytes_ + mapped_.mappings.size() * kBytesPerMapping + (kOpenSources + 1) * kHdf5MetadataBytes;
  }

  void read(const Box& box, std::span<std::byte> stored) override {
    const Hdf5ReadLock lock(crash_line_);
    const Hdf5Handle wanted = select_box(space_.get(), ArrayPlace::behind(index_), box);
    const AxisBox placed = axis_box(index_, box, components_);
    std::vector<hsize_t> dims;
    for (std::size_t i = 0; i < placed.lo.size(); ++i) dims.push_back(placed.hi[i] - placed.lo[i]);
    if (!fill_.empty()) repeat_value(fill_, stored);  // elements without a source keep the fill value
    const std::vector<hssize_t> corner(placed.lo.begin(), placed.lo.end());
    for (const VirtualMapping& mapping : mapped_.mappings) {
      if (!overlap(mapping.bounds, placed)) continue;
      // Both selections list their elements in row-major order of the virtual dataset.
      const Hdf5Handle part(H5Scombine_select(mapping.in_virtual.get(), H5S_SELECT_AND, wanted.get()));
      if (H5Sget_select_npoints(part.get()) <= 0) continue;
      const Hdf5Handle in_source(
          H5Sselect_project_intersection(mapping.in_virtual.get(), mapping.in_source.get(), wanted.get()));
      const Hdf5Handle in_memory(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr));
      H5Sselect_adjust(part.get(), corner.data());
      H5Sselect_copy(in_memory.get(), part.get());
      if (H5Dread(source_of(mapping), type_.get(), in_memory.get(), in_source.get(), H5P_DEFAULT, stored.data()) < 0) {
        throw hdf5_error(where_, cat("its source ", mapping.file, mapping.file.empty() ? "" : ": ", mapping.dataset,
                                     " cannot be read, it is cut short or damaged"));
      }
    }
  }

 private:
  struct OpenSource {
    const VirtualMapping* mapping;
    Hdf5Handle dataset;
  };

  hid_t source_of(const VirtualMapping& mapping) {
    const auto found = std::ranges::find(open_, &mapping, &OpenSource::mapping);
    if (found != open_.end()) {
      open_.splice(open_.begin(), open_, found);
    } else {
      if (open_.size() == kOpenSources) open_.pop_back();
      open_.push_front({&mapping, open_virtual_source(dataset_.get(), mapping.file, mapping.dataset, where_)});
    }
    return open_.front().dataset.get();
  }

  Hdf5Handle dataset_;
  std::vector<std::int64_t> index_;
  std::int64_t components_;
  std::string where_;
  std::string crash_line_;
  Hdf5Handle type_;
  Hdf5Handle space_;
  VirtualMappings mapped_;
  std::vector<std::byte> fill_;  ///< a stored value; empty if sources give every element
  std::list<OpenSource> open_;   ///< the most recently used source first
  Index3 chunk_{0, 0, 0};
  Index3 chunk_origin_{0, 0, 0};
  std::uint64_t chunk_bytes_ = 0;
};

}  // namespace

VirtualVolume make_virtual_boxes(Hdf5Handle dataset, std::vector<std::int64_t> index, const WantedVoxels& wanted,
                                 std::int64_t components, const std::string& parent, const std::string& where) {
  auto boxes = std::make_unique<VirtualBoxes>(std::move(dataset), std::move(index), wanted, components, parent, where);
  Uncovered unmapped = boxes->unmapped();
  UnwrittenInSources unwritten = boxes->unwritten();
  return {std::move(boxes), std::move(unmapped), std::move(unwritten)};
}

}  // namespace weir
