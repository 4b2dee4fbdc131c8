#include "ingest/hdf5/hdf5_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/file_states.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/hdf5/meaning/dataset_choice.h"
#include "ingest/hdf5/meaning/dataset_facts.h"
#include "ingest/hdf5/meaning/elements_read.h"
#include "ingest/hdf5/meaning/field_meaning.h"
#include "ingest/hdf5/meaning/hdf5_lookup.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/hdf5/storage/absent_values.h"
#include "ingest/hdf5/storage/chunk_reader.h"
#include "ingest/hdf5/storage/chunked_source.h"
#include "ingest/hdf5/storage/constant_source.h"
#include "ingest/hdf5/storage/external_files.h"
#include "ingest/hdf5/storage/planar_boxes.h"
#include "ingest/hdf5/storage/unwritten_chunks.h"
#include "ingest/hdf5/virtual/library_boxes.h"
#include "ingest/hdf5/virtual/virtual_boxes.h"
#include "ingest/source/extent.h"
#include "ingest/source/reversed_source.h"
#include "ingest/values/decode_values.h"
#include "ingest/values/raw_values.h"
#include "ingest/values/value_notes.h"

namespace weir {
namespace {

/// A dataset that is being opened: the common input of all the ways to read it.
struct Opening {
  Hdf5Object object;
  DatasetFacts facts;
  VolumeSlice slice;
  SourceInfo info;
  const SourceOptions& options;
  bool all_stored = false;  ///< the index of its chunks has as many as there must be

  /// Notes the opened file and the files that links and mappings led to. An empty name stands for the dataset's own
  /// file.
  void note_files(const std::vector<std::string>& further) {
    std::set<std::string> others(further.begin(), further.end());
    others.erase("");
    others.erase(info.path);
    FileStates files;
    files.add(info.path);
    for (const std::string& path : others) files.add(path);
    info.files_digest = files.digest();
    info.files = files.files();
  }
  /// Returns whether no value of a contiguous dataset was ever written. For chunked datasets the number of chunks
  /// says this.
  bool all_fill() const { return facts.storage->is_all_fill && facts.storage->kind == StorageKind::contiguous; }
  /// Returns the bytes of the array before the slice, which lies in one piece.
  std::uint64_t first_byte() const {
    std::uint64_t position = 0;
    for (std::size_t i = 0; i < slice.positions.size(); ++i) {
      position =
          position * static_cast<std::uint64_t>(facts.axes[i].extent) + static_cast<std::uint64_t>(slice.positions[i]);
    }
    return position * slice_bytes();
  }
  std::uint64_t slice_bytes() const { return static_cast<std::uint64_t>(volume(slice.extent)) * voxel_bytes(); }
  Box voxels_read() const { return weir::voxels_read(slice, options.roi); }
  WantedVoxels wanted() const { return {voxels_read(), !options.roi}; }
  /// Returns the words that say whether the read elements belong to the region or to the whole volume.
  const char* of_read() const { return options.roi ? " of the region's " : " of its "; }
  std::size_t voxel_bytes() const {
    return scalar_bytes(facts.type->scalar) * static_cast<std::size_t>(slice.components.count);
  }
  std::unique_ptr<VolumeSource> from_raw(std::unique_ptr<InputFile> file, std::uint64_t offset) {
    const RawLayout layout{offset, facts.type->scalar, facts.type->big_endian, info.mapping, slice.components};
    return make_raw_values(std::move(file), layout, std::move(info));
  }
  std::unique_ptr<VolumeSource> from_boxes(std::unique_ptr<StoredBoxes> boxes) {
    return make_stored_box_source(std::move(boxes), std::move(info), facts.type->big_endian, options.memory,
                                  object.where(), slice.components);
  }
};

std::unique_ptr<VolumeSource> open_contiguous(Opening opening) {
  const haddr_t begin = H5Dget_offset(opening.object.handle.get());
  auto file = std::make_unique<InputFile>(file_of(opening.object.handle.get()), opening.options.direct_io);
  const std::uint64_t end_of_slice = opening.first_byte() + opening.slice_bytes();
  if (begin == HADDR_UNDEF || begin > file->size() || end_of_slice > file->size() - begin) {
    throw Error(ErrorKind::input,
                cat(opening.object.where(), ": its values end ", end_of_slice, " bytes after ", begin, ", and ",
                    file->path(), " has ", file->size(), " bytes; it is cut short or damaged"));
  }
  return opening.from_raw(std::move(file), begin + opening.first_byte());
}

std::unique_ptr<VolumeSource> open_external(Opening opening) {
  const Hdf5Handle creation(H5Dget_create_plist(opening.object.handle.get()));
  std::uint64_t bytes = opening.slice_bytes();
  for (std::size_t i = 0; i < opening.slice.positions.size(); ++i) {
    bytes *= static_cast<std::uint64_t>(opening.facts.axes[i].extent);
  }
  std::vector<ExternalPart> parts =
      external_parts(creation.get(), bytes, file_of(opening.object.handle.get()), opening.object.where());
  std::vector<std::string> files{file_of(opening.object.handle.get())};
  for (const ExternalPart& part : parts) files.push_back(part.path);
  opening.note_files(files);
  const std::uint64_t first = opening.first_byte();
  if (parts.size() == 1) {
    auto file = std::make_unique<InputFile>(parts[0].path, opening.options.direct_io);
    return opening.from_raw(std::move(file), parts[0].offset + first);
  }
  auto boxes = make_external_boxes(std::move(parts), opening.slice.extent, opening.voxel_bytes(), first,
                                   opening.options.direct_io);
  return opening.from_boxes(std::move(boxes));
}

std::unique_ptr<VolumeSource> open_by_library(Opening opening) {
  ArrayPlace place{opening.slice.roles.volume, opening.slice.positions};
  return opening.from_boxes(make_library_boxes(std::move(opening.object.handle), *opening.facts.storage,
                                               std::move(place), opening.object.where()));
}

void refuse_where_all_must_be(const Opening& opening, const AbsentValues& absent) {
  if (opening.options.missing_chunks != MissingChunks::error) return;
  throw input_error(
      opening.object.where(),
      compose(absent.text(), absent.first, ", and with ", option("missing-chunks", "error"),
              absent.no_source ? " all must have one; map one to them, or use " : " all must be; write them, or use ",
              option("missing-chunks", "fill")));
}

// Refuses absent values, or notes the fill value that they read as.
void note_filled(Opening& opening, const AbsentValues& absent) {
  refuse_where_all_must_be(opening, absent);
  std::array<float, 1> fill{};
  const StoredType& type = *opening.facts.type;
  const auto decode = [&](const ValueMapping& mapping) {
    decode_values(opening.facts.storage->fill, type.scalar, type.big_endian, mapping, fill);
  };
  decode(opening.facts.meaning.mapping);
  if (!std::isfinite(fill[0])) decode({});  // the fill value stands for missing data: show it as stored
  opening.info.details.chunks_note =
      cat(absent.text(), " and ", absent.one ? "reads" : "read", " as its fill value, ", fill[0]);
}

// Notes or refuses chunks that read as the fill value.
void note_unwritten(Opening& opening) {
  const Storage& storage = *opening.facts.storage;
  if (opening.all_fill()) return note_filled(opening, {"its values"});
  if (storage.kind != StorageKind::chunked || storage.chunk.size() != opening.facts.axes.size()) return;
  const ElementRange read = elements_read(opening.facts.axes, opening.slice, opening.options.roi);
  const UnwrittenChunks unwritten =
      unwritten_chunks(opening.object.handle.get(), storage.chunk, read, opening.object.where());
  opening.all_stored = unwritten.count == 0;
  if (opening.all_stored) return;
  const char* const of = unwritten.elsewhere ? " of all " : opening.of_read();
  const std::string count = cat(unwritten.count, of, unwritten.all, unwritten.all == 1 ? " chunk" : " chunks",
                                unwritten.elsewhere ? ", some perhaps outside what is read," : "");
  const std::string first = unwritten.first.empty() ? "" : cat(" (the first at ", corner_text(unwritten.first), ")");
  note_filled(opening, {count, unwritten.count == 1, first});
}

// Notes or refuses elements of a virtual dataset that no source is mapped to.
void note_unmapped(Opening& opening, const Uncovered& unmapped) {
  if (unmapped.count == 0) return;
  const std::int64_t all = opening.voxels_read().voxels() * opening.slice.components.count;
  note_filled(opening, {cat(unmapped.count, opening.of_read(), all, " values"), unmapped.count == 1,
                        cat(" (the first at ", corner_text(unmapped.first), ")"), true});
}

// Notes or refuses unwritten chunks of a virtual dataset's sources. Each source has its own fill value.
void note_unwritten_in_sources(Opening& opening, const UnwrittenInSources& unwritten) {
  if (unwritten.count == 0) return;
  const bool one = unwritten.count == 1;
  const AbsentValues absent{cat(unwritten.count, one ? " chunk of its sources" : " chunks of its sources"), one,
                            unwritten.first.empty() ? "" : cat(" (the first at ", unwritten.first, ")")};
  refuse_where_all_must_be(opening, absent);
  add_note(cat(absent.text(), one ? " and reads as a fill value" : " and read as fill values"),
           opening.info.details.chunks_note);
}

std::unique_ptr<StoredBoxes> open_mapped(Opening& opening, const std::string& parent) {
  VirtualVolume mapped = make_virtual_boxes(std::move(opening.object.handle), opening.slice.positions, opening.wanted(),
                                            opening.slice.components.count, parent, opening.object.where());
  note_unmapped(opening, mapped.unmapped);
  note_unwritten_in_sources(opening, mapped.unwritten);
  return std::move(mapped.boxes);
}

// Opens vectors to read their magnitude, of which each component is read apart: they lie in volumes one behind the
// other, or in chunks of their own.
std::unique_ptr<VolumeSource> open_planar(Opening opening) {
  const StorageKind kind = opening.facts.storage->kind;
  const std::string parent = file_of(opening.object.handle.get());
  const std::string where = opening.object.where();
  std::vector<std::unique_ptr<StoredBoxes>> parts;
  Uncovered unmapped;
  UnwrittenInSources unwritten;
  if (kind == StorageKind::external) {
    throw Error(ErrorKind::input, compose(where, ": its components lie behind each other in files of their own; ",
                                          "convert them one by one, with ", option("component", 0)));
  }
  for (std::int64_t c = 0; c < opening.slice.components.count; ++c) {
    std::vector<std::int64_t> index = opening.slice.positions;
    index.push_back(c);
    H5Iinc_ref(opening.object.handle.get());
    Hdf5Handle dataset(opening.object.handle.get());
    if (kind == StorageKind::mapped) {
      VirtualVolume part = make_virtual_boxes(std::move(dataset), index, opening.wanted(), 1, parent, where);
      unmapped.count += part.unmapped.count;
      if (unmapped.first.empty()) unmapped.first = part.unmapped.first;
      unwritten.add(part.unwritten);
      parts.push_back(std::move(part.boxes));
    } else {
      ArrayPlace place{opening.slice.roles.volume, index};
      parts.push_back(make_library_boxes(std::move(dataset), *opening.facts.storage, std::move(place), where));
    }
  }
  note_unmapped(opening, unmapped);
  note_unwritten_in_sources(opening, unwritten);
  auto boxes = make_planar_boxes(std::move(parts), scalar_bytes(opening.facts.type->scalar));
  std::vector<std::string> files = boxes->files();
  files.push_back(parent);
  opening.note_files(files);
  return opening.from_boxes(std::move(boxes));
}

std::unique_ptr<VolumeSource> open_chunked(Opening opening) {
  const hid_t dataset = opening.object.handle.get();
  if (!ChunkReader::decodes(dataset)) {
    const VoxelComponents components = opening.slice.components;
    const bool split = components.count > 1 && std::cmp_less(opening.facts.storage->chunk.back(), components.count);
    if (split && components.choice.magnitude) return open_planar(std::move(opening));
    if (split) {  // reads the chunks of this component alone
      opening.slice.positions.push_back(components.choice.position);
      opening.slice.components = {};
    }
    return open_by_library(std::move(opening));
  }
  ChunkedSlice slice{dataset,
                     opening.object.where(),
                     opening.slice.positions,
                     opening.facts.type->scalar,
                     opening.facts.type->big_endian,
                     opening.info.mapping,
                     opening.facts.storage->fill,
                     opening.slice.components,
                     opening.all_stored};
  return make_chunked_source(std::move(opening.object.handle), std::move(slice), std::move(opening.info),
                             opening.options.memory);
}

// Returns whether the time is the last axis, behind those of space, and weir itself decodes the chunks.
bool has_chunks_of_times(const Opening& opening) {
  const AxisRoles& roles = opening.slice.roles;
  const std::size_t last = opening.facts.axes.size() - 1;
  return opening.facts.storage->kind == StorageKind::chunked && opening.slice.components.count == 1 &&
         roles.others.back() == last && roles.volume[0] + kVolumeRank == last && opening.facts.axes[last].extent > 1 &&
         ChunkReader::decodes(opening.object.handle.get());
}

// Opens a volume with a time axis between or after the axes of space. The library gathers the scattered values, except
// if the times of a voxel lie side by side in chunks, as components do.
std::unique_ptr<VolumeSource> open_interleaved(Opening opening) {
  const StorageKind kind = opening.facts.storage->kind;
  if (has_chunks_of_times(opening)) {
    opening.slice.components = {opening.facts.axes.back().extent, {false, opening.slice.positions.back()}};
    opening.slice.positions.pop_back();
    return open_chunked(std::move(opening));
  }
  if (kind != StorageKind::external && kind != StorageKind::mapped) return open_by_library(std::move(opening));
  throw Error(ErrorKind::input, cat(opening.object.where(), ": its axes are ", axes_text(opening.facts.axes),
                                    ", the time not before those of space, and its values lie in other files; write "
                                    "it with the time first, or into one file"));
}

std::unique_ptr<VolumeSource> open_stored(Opening opening) {
  note_unwritten(opening);
  if (opening.slice.roles.interleaved()) return open_interleaved(std::move(opening));
  if (opening.slice.planar) return open_planar(std::move(opening));
  switch (opening.facts.storage->kind) {
    case StorageKind::contiguous:
      return opening.all_fill() ? open_by_library(std::move(opening)) : open_contiguous(std::move(opening));
    case StorageKind::external:
      return open_external(std::move(opening));
    case StorageKind::chunked:
      return open_chunked(std::move(opening));
    case StorageKind::compact:
      return open_by_library(std::move(opening));
    case StorageKind::mapped:
      break;
  }
  const std::string parent = file_of(opening.object.handle.get());
  auto boxes = open_mapped(opening, parent);
  std::vector<std::string> files = boxes->files();
  files.push_back(parent);
  opening.note_files(files);
  return opening.from_boxes(std::move(boxes));
}

// Opens a constant. All components of a voxel have the same value.
std::unique_ptr<VolumeSource> open_constant(Opening opening) {
  const VoxelComponents& components = opening.slice.components;
  const double value = *opening.facts.constant;
  const bool length = components.count > 1 && components.choice.magnitude;
  return make_constant_source(length ? std::fabs(value) * std::sqrt(static_cast<double>(components.count)) : value,
                              std::move(opening.info));
}

// Refuses a dataset with an obstacle. A volume over time is made only if the user names the dataset and gives the
// spacing of its planes.
void check_obstacle(const Opening& opening) {
  const DatasetFacts& facts = opening.facts;
  const std::string where = opening.object.where();
  if (facts.obstacle.empty() || (facts.over_time && opening.options.spacing)) return;
  const bool planes_over_time = facts.over_time && facts.axes.size() == kVolumeRank;
  if (!planes_over_time) throw Error(ErrorKind::input, cat(where, ": ", facts.obstacle));
  throw Error(ErrorKind::input,
              compose(where, ": ", facts.obstacle, "; to take the time for a length, give ", option("spacing")));
}

// Checks that the array's bytes, leading axes included, fit 63 bits.
void check_bytes(const Opening& opening) {
  std::uint64_t bytes = checked_volume_bytes(opening.slice.extent, opening.voxel_bytes(), opening.object.where());
  for (const std::size_t axis : opening.slice.roles.others) {
    const auto extent = static_cast<std::uint64_t>(opening.facts.axes[axis].extent);
    if (extent > (~std::uint64_t{0} >> 1U) / bytes) {
      throw Error(ErrorKind::input, cat(opening.object.where(), ": ", axes_text(opening.facts.axes),
                                        " values are more than 63 bits count; the file is damaged"));
    }
    bytes *= extent;
  }
}

SourceInfo source_info(const std::string& path, const Opening& opening) {
  const InputFile file(path, DirectIo::off);
  SourceInfo info;
  info.path = path;
  info.format = "hdf5";
  info.dataset = opening.object.name;
  info.index = opening.slice.index;
  info.axis_labels = opening.slice.labels;
  info.units = opening.facts.meaning.units;
  info.unit_si = opening.facts.meaning.unit_si;
  info.extent = opening.slice.extent;
  info.type = opening.facts.type->scalar;
  info.mapping = opening.facts.meaning.mapping;
  opening.options.complete(info.mapping);
  info.lengths = opening.slice.components.count > 1 && opening.slice.components.choice.magnitude;
  info.spacing = opening.slice.spacing;
  info.origin = opening.slice.origin;
  for (std::size_t i = 0; i < kVolumeRank; ++i) {
    const AxisPlace& axis = opening.facts.axes[opening.slice.roles.volume.at(kVolumeRank - 1 - i)];
    info.spacing_from.at(i) = axis.spacing_from;
    info.origin_from.at(i) = axis.origin_from;
  }
  info.file_bytes = file.size();
  info.mtime_ns = file.mtime_ns();
  return info;
}

}  // namespace

std::unique_ptr<VolumeSource> open_hdf5(const std::string& path, const SourceOptions& options) {
  const Hdf5Lock lock;
  const Hdf5Handle file = open_hdf5_file(path);
  Opening opening{options.dataset.empty() ? only_volume(file.get(), path, options)
                                          : find_dataset(file.get(), path, options.dataset),
                  {},
                  {},
                  {},
                  options};
  const std::string where = opening.object.where();
  opening.facts = dataset_facts(file.get(), opening.object);
  check_obstacle(opening);
  opening.slice = volume_slice(opening.facts.axes, options.index, where, options.component);
  check_bytes(opening);
  opening.info = source_info(path, opening);
  opening.info.details = field_details(file.get(), opening.object, opening.facts.axes, opening.slice);
  opening.info.details.values_note = opening.facts.meaning.note;
  if (!options.spacing) add_note(opening.facts.place_note, opening.info.details.values_note);
  opening.note_files({file_of(opening.object.handle.get())});
  if (options.component) opening.info.details.component = component_text(*options.component);
  const std::array<bool, 3> falls = opening.slice.falls;
  if (opening.facts.constant) return open_constant(std::move(opening));
  return reverse_axes(open_stored(std::move(opening)), falls);
}

}  // namespace weir
