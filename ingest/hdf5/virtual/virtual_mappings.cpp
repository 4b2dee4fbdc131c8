#include "ingest/hdf5/virtual/virtual_mappings.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/hdf5/file/hdf5_type.h"
#include "ingest/hdf5/file/side_files.h"
#include "ingest/hdf5/meaning/value_meaning.h"
#include "ingest/hdf5/storage/chunk_store.h"
#include "ingest/hdf5/storage/storage.h"
#include "ingest/hdf5/storage/unwritten_chunks.h"
#include "ingest/hdf5/virtual/coverage.h"
#include "ingest/hdf5/virtual/selection_blocks.h"
#include "ingest/source/convert_command.h"

namespace weir {
namespace {

constexpr std::size_t kMostBlocks = std::size_t{1} << 20U;  // of all mappings of a volume
constexpr std::size_t kMostNameBytes = 4096;
constexpr const char* kVirtualPrefix = "HDF5_VDS_PREFIX";

std::vector<hsize_t> dims_of(hid_t space) {
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims;
}

template <typename T>
std::string list_text(const std::vector<T>& values) {
  std::string text;
  for (const T& v : values) text += cat(text.empty() ? "" : ", ", v);
  return text;
}

// Returns the command that makes one dataset. h5repack needs a layout: without one it copies a virtual dataset with
// its mappings (H5Ocopy).
std::string as_one_dataset(const std::string& file) {
  return cat("write it as one with h5repack -l CONTI ", shell_word(file), " NEW");
}

/// A hyperslab that may be unlimited along one axis.
struct MappedSlab {
  explicit MappedSlab(std::size_t rank) : start(rank), stride(rank), count(rank), block(rank) {}

  static std::optional<MappedSlab> of(hid_t space) {
    const int axes = H5Sget_simple_extent_ndims(space);
    if (axes <= 0 || H5Sget_select_type(space) != H5S_SEL_HYPERSLABS || H5Sis_regular_hyperslab(space) <= 0) return {};
    MappedSlab slab(static_cast<std::size_t>(axes));
    if (H5Sget_regular_hyperslab(space, slab.start.data(), slab.stride.data(), slab.count.data(), slab.block.data()) <
        0) {
      return {};
    }
    for (std::size_t axis = 0; axis < slab.start.size(); ++axis) {
      if (slab.count[axis] == H5S_UNLIMITED || slab.block[axis] == H5S_UNLIMITED) slab.endless = axis;
    }
    return slab;
  }

  /// Returns whether elements follow each other without gaps along the unlimited axis.
  bool dense() const { return block[*endless] == H5S_UNLIMITED || stride[*endless] == block[*endless]; }
  /// Returns how many blocks fit in `extent` elements along the unlimited axis; for a dense hyperslab, how many
  /// elements.
  hsize_t room(hsize_t extent) const {
    const hsize_t from = start[*endless];
    if (extent <= from) return 0;
    if (dense()) return extent - from;
    return extent - from < block[*endless] ? 0 : (extent - from - block[*endless]) / stride[*endless] + 1;
  }
  void cut(hsize_t blocks) {
    const bool joined = dense();
    count[*endless] = joined ? 1 : blocks;
    block[*endless] = joined ? blocks : block[*endless];
    stride[*endless] = std::max(stride[*endless], block[*endless]);
  }
  void select(hid_t space) const {
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), stride.data(), count.data(), block.data());
  }

  std::vector<hsize_t> start;
  std::vector<hsize_t> stride;
  std::vector<hsize_t> count;
  std::vector<hsize_t> block;
  std::optional<std::size_t> endless;  ///< axis
};

/// A mapping as the file stores it.
struct StoredMapping {
  std::string file;
  std::string dataset;
  Hdf5Handle in_source;
  Hdf5Handle in_virtual;

  bool numbered() const {
    return virtual_source_name(file, 0) != virtual_source_name(file, 1) ||
           virtual_source_name(dataset, 0) != virtual_source_name(dataset, 1);
  }
};

class MappingReader {
 public:
  MappingReader(hid_t dataset, const WantedElements& wanted, const std::string& parent, const std::string& where)
      : dataset_(dataset),
        wanted_(wanted.box),
        need_a_source_(wanted.need_a_source),
        parent_(parent),
        where_(where),
        space_(H5Dget_space(dataset)) {}

  VirtualMappings run() {
    const Hdf5Handle creation(H5Dget_create_plist(dataset_));
    std::size_t count = 0;
    H5Pget_virtual_count(creation.get(), &count);
    for (std::size_t i = 0; i < count; ++i) take(stored(creation.get(), i));
    if (mappings_.empty() && need_a_source_) {
      throw error(cat("no source is mapped to its element ", list_text(wanted_.lo),
                      ", nor to any other of the volume; the dataset is incomplete"));
    }
    Uncovered unmapped = uncovered(wanted_, blocks_);
    return {std::move(mappings_), std::move(unmapped), std::move(unwritten_)};
  }

 private:
  Error error(const std::string& what) const { return {ErrorKind::input, cat(where_, ": ", what)}; }

  std::string source_text(const VirtualMapping& found) const { return cat("its source ", source_name(found), ": "); }
  std::string source_name(const VirtualMapping& found) const {
    return cat(found.file.empty() ? parent_ : found.file, ": ", found.dataset);
  }

  StoredMapping stored(hid_t creation, std::size_t i) const {
    const auto name = [&](auto get) {
      std::vector<char> text(kMostNameBytes + 1, '\0');
      const ssize_t length = get(creation, i, text.data(), text.size());
      if (length < 0 || static_cast<std::size_t>(length) > kMostNameBytes) {
        throw error(cat("its mapping ", i, " cannot be read; the file is damaged"));
      }
      return std::string(text.data());
    };
    return {name(H5Pget_virtual_filename), name(H5Pget_virtual_dsetname),
            Hdf5Handle(H5Pget_virtual_srcspace(creation, i)), Hdf5Handle(H5Pget_virtual_vspace(creation, i))};
  }

  void take(const StoredMapping& mapping) {
    std::optional<MappedSlab> slab = MappedSlab::of(mapping.in_virtual.get());
    if (slab && slab->endless && mapping.numbered()) return take_numbered(mapping, *slab);
    VirtualMapping found;
    found.in_virtual = Hdf5Handle(H5Scopy(space_.get()));
    const bool endless = slab && slab->endless;
    if (!endless) {
      select_as(mapping.in_virtual.get(), found.in_virtual.get());
      if (!touches(found.in_virtual.get())) return;
    }
    const Hdf5Handle opened = look_at_source(mapping, 0, found);
    if (endless) {
      std::optional<MappedSlab> source = MappedSlab::of(mapping.in_source.get());
      if (!source || !source->endless || source->dense() != slab->dense()) {
        throw error(cat("a mapping goes on without end in a way that weir does not follow; ", as_one_dataset(parent_)));
      }
      const hsize_t blocks = std::min(slab->room(dims_of(space_.get())[*slab->endless]),
                                      source->room(dims_of(found.in_source.get())[*source->endless]));
      if (blocks == 0) return;
      slab->cut(blocks);
      source->cut(blocks);
      slab->select(found.in_virtual.get());
      source->select(found.in_source.get());
      if (!touches(found.in_virtual.get())) return;
    }
    keep(std::move(found), opened.get());
  }

  void take_numbered(const StoredMapping& mapping, const MappedSlab& slab) {
    const std::size_t axis = *slab.endless;
    const hsize_t extent = dims_of(space_.get())[axis];
    for (hsize_t block = 0;; ++block) {
      MappedSlab one = slab;
      one.start[axis] += block * slab.stride[axis];
      one.count[axis] = 1;
      if (slab.block[axis] == H5S_UNLIMITED || one.start[axis] >= extent || block > kMostBlocks) return;
      VirtualMapping found;
      found.in_virtual = Hdf5Handle(H5Scopy(space_.get()));
      one.select(found.in_virtual.get());
      if (!touches(found.in_virtual.get())) continue;
      const Hdf5Handle opened = look_at_source(mapping, block, found);
      keep(std::move(found), opened.get());
    }
  }

  // Selects in `into`, as a hyperslab, the selection of `from`, which may select all elements.
  static void select_as(hid_t from, hid_t into) {
    if (H5Sget_select_type(from) == H5S_SEL_HYPERSLABS) {
      H5Sselect_copy(into, from);
      return;
    }
    const std::vector<hsize_t> dims = dims_of(into);
    const std::vector<hsize_t> start(dims.size(), 0);
    H5Sselect_hyperslab(into, H5S_SELECT_SET, start.data(), nullptr, dims.data(), nullptr);
  }

  bool touches(hid_t space) const {
    std::vector<hsize_t> last(wanted_.hi.begin(), wanted_.hi.end());
    for (hsize_t& hi : last) --hi;
    const std::vector<hsize_t> first(wanted_.lo.begin(), wanted_.lo.end());
    return H5Sselect_intersect_block(space, first.data(), last.data()) > 0;
  }

  /// Returns the opened source.
  Hdf5Handle look_at_source(const StoredMapping& mapping, hsize_t block, VirtualMapping& found) const {
    found.dataset = virtual_source_name(mapping.dataset, block);
    const std::string file = virtual_source_name(mapping.file, block);
    if (file != ".") {
      const auto path = find_side_file(file, parent_, kVirtualPrefix);
      if (!path) {
        throw error(
            cat("its source file ", file, " is not there; put it beside ", parent_, " or set ", kVirtualPrefix));
      }
      found.file = *path;
    }
    Hdf5Handle source = open_virtual_source(dataset_, found.file, found.dataset, where_);
    const Storage storage = storage_of(source.get());
    const auto refuse = [&](const std::string& what) { return error(source_text(found) + what); };
    const Hdf5Handle type(H5Dget_type(source.get()));
    const auto number = stored_type(type.get());
    // Uses the same rule as for such a dataset that is read alone (dataset_facts.cpp).
    found.all_fill = storage.is_all_fill && number && !may_be_netcdf_fill(source.get(), *number, storage.fill);
    if (!storage.obstacle.empty() && !found.all_fill) throw refuse(storage.obstacle);
    if (storage.kind == StorageKind::mapped) {
      const std::string& in = found.file.empty() ? parent_ : found.file;
      throw refuse(cat("is spread over other datasets itself; ", as_one_dataset(in), ", and put NEW in its place"));
    }
    if (storage.kind == StorageKind::external) {
      throw refuse("has its values in external files; write it with the values in its own file");
    }
    found.chunk = storage.chunk;
    found.value_bytes = H5Tget_size(type.get());
    found.in_source = Hdf5Handle(H5Dget_space(source.get()));
    const bool endless = MappedSlab::of(mapping.in_source.get()).value_or(MappedSlab(0)).endless.has_value();
    if (!endless) {
      const bool all = H5Sget_select_type(mapping.in_source.get()) != H5S_SEL_HYPERSLABS;
      const bool fits = all || H5Sget_simple_extent_ndims(mapping.in_source.get()) ==
                                   H5Sget_simple_extent_ndims(found.in_source.get());
      if (fits) select_as(mapping.in_source.get(), found.in_source.get());
      if (!fits || H5Sselect_valid(found.in_source.get()) <= 0) {
        throw refuse(cat("has extents ", list_text(dims_of(found.in_source.get())), ", fewer than the mapping needs"));
      }
    }
    return source;
  }

  void keep(VirtualMapping found, hid_t source) {
    const hssize_t mapped = H5Sget_select_npoints(found.in_virtual.get());
    const hssize_t held = H5Sget_select_npoints(found.in_source.get());
    if (mapped != held) throw error(cat(source_text(found), "has ", held, " elements where ", mapped, " are mapped"));
    const auto blocks = selection_blocks(found.in_virtual.get(), kMostBlocks - blocks_.size());
    if (!blocks) throw error(cat("its mappings have too many pieces; ", as_one_dataset(parent_)));
    blocks_.insert(blocks_.end(), blocks->begin(), blocks->end());
    std::vector<hsize_t> first(wanted_.lo.size());
    std::vector<hsize_t> last(first.size());
    H5Sget_select_bounds(found.in_virtual.get(), first.data(), last.data());
    found.bounds = {{first.begin(), first.end()}, {last.begin(), last.end()}};
    for (hsize_t& hi : found.bounds.hi) ++hi;
    unwritten_.add(unwritten_in(source, found));
    mappings_.push_back(std::move(found));
  }

  // Elements of the source that are not read may be unwritten: for example later steps of a running simulation.
  UnwrittenInSources unwritten_in(hid_t source, const VirtualMapping& found) const {
    if (found.chunk.empty() && !found.all_fill) return {};
    std::vector<hsize_t> count;
    for (std::size_t axis = 0; axis < wanted_.lo.size(); ++axis) count.push_back(wanted_.hi[axis] - wanted_.lo[axis]);
    const Hdf5Handle wanted(H5Scopy(space_.get()));
    H5Sselect_hyperslab(wanted.get(), H5S_SELECT_SET, wanted_.lo.data(), nullptr, count.data(), nullptr);
    const Hdf5Handle read(H5Sselect_project_intersection(found.in_virtual.get(), found.in_source.get(), wanted.get()));
    if (H5Sget_select_npoints(read.get()) <= 0) return {};
    const auto placed = [&](std::span<const hsize_t> first) {
      return cat(corner_text(first), " of ", source_name(found));
    };
    if (found.chunk.empty()) return {1, placed(std::vector<hsize_t>(dims_of(read.get()).size()))};
    const UnwrittenChunks unwritten =
        unwritten_chunks(source, found.chunk, read.get(), cat(where_, ": its source ", source_name(found)));
    if (unwritten.first.empty()) return {unwritten.count, {}};
    return {unwritten.count, placed(unwritten.first)};
  }

  hid_t dataset_;
  const AxisBox& wanted_;
  const bool need_a_source_;
  const std::string& parent_;
  const std::string& where_;
  Hdf5Handle space_;
  std::vector<VirtualMapping> mappings_;
  std::vector<AxisBox> blocks_;
  UnwrittenInSources unwritten_;
};

}  // namespace

void UnwrittenInSources::add(const UnwrittenInSources& further) {
  if (first.empty()) first = further.first;
  count += further.count;
}

VirtualMappings virtual_mappings(hid_t dataset, const WantedElements& wanted, const std::string& parent,
                                 const std::string& where) {
  return MappingReader(dataset, wanted, parent, where).run();
}

Hdf5Handle open_virtual_source(hid_t virtual_dataset, const std::string& file, const std::string& dataset,
                               const std::string& where) {
  Hdf5Handle opened;
  try {
    opened = file.empty() ? Hdf5Handle(H5Iget_file_id(virtual_dataset)) : open_hdf5_file(file);
  } catch (const Error& error) {
    throw Error(error.kind(), compose(where, ": its source ", error.message()), error.system_failure());
  }
  Hdf5Handle source(H5Dopen2(opened.get(), dataset.c_str(), H5P_DEFAULT));
  if (source) return source;
  throw hdf5_error(where, cat("its source ", file, file.empty() ? "" : ": ", dataset, " cannot be opened"));
}

std::string virtual_source_name(const std::string& stored, std::uint64_t block) {
  std::string name;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const char next = stored[i] == '%' && i + 1 < stored.size() ? stored[i + 1] : '\0';
    if (next != 'b' && next != '%') {
      name += stored[i];
      continue;
    }
    name += next == 'b' ? std::to_string(block) : "%";
    ++i;
  }
  return name;
}

}  // namespace weir
