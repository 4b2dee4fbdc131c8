#include "ingest/hdf5/hdf5_source.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/file_states.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/hdf5/meaning/dataset_choice.h"
#include "ingest/hdf5/meaning/dataset_facts.h"
#include "ingest/hdf5/meaning/hdf5_lookup.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/hdf5/storage/chunk_reader.h"
#include "ingest/hdf5/storage/constant_source.h"
#include "ingest/hdf5/storage/external_files.h"
#include "ingest/hdf5/virtual/library_boxes.h"
#include "ingest/hdf5/virtual/virtual_boxes.h"
#include "ingest/source/extent.h"
#include "ingest/values/raw_values.h"

namespace weir {
namespace {

/// Chunks that weir decodes itself.
class ChunkedSource final : public VolumeSource {
 public:
  ChunkedSource(Hdf5Handle dataset, ChunkedSlice slice, SourceInfo info, std::uint64_t memory)
      : dataset_(std::move(dataset)), info_(std::move(info)), reader_(std::move(slice), memory) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return reader_.access(); }
  std::uint64_t working_bytes() const override { return reader_.working_bytes() + kHdf5MetadataBytes; }
  std::uint64_t bytes_read() const override { return reader_.counts().bytes_read; }
  ConversionLoss read(const Box& box, std::span<float> values) override { return reader_.read(box, values); }

 private:
  Hdf5Handle dataset_;
  SourceInfo info_;
  ChunkReader reader_;
};

// The file a dataset lies in, which an external link may have led to.
std::string file_of(hid_t dataset) {
  std::array<char, 4096> name{};
  const ssize_t length = H5Fget_name(dataset, name.data(), name.size());
  return length > 0 && static_cast<std::size_t>(length) < name.size() ? name.data() : "";
}

/// A dataset that is being opened: what all ways of reading it start from.
struct Opening {
  Hdf5Object object;
  DatasetFacts facts;
  VolumeSlice slice;
  SourceInfo info;
  const SourceOptions& options;

  /// The file that was opened and those that links and mappings led to; empty names are the dataset's own.
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
  /// Bytes of the array before the slice.
  std::uint64_t first_byte() const {
    std::uint64_t position = 0;
    for (std::size_t i = 0; i < slice.index.size(); ++i) {
      position =
          position * static_cast<std::uint64_t>(facts.axes[i].extent) + static_cast<std::uint64_t>(slice.index[i]);
    }
    return position * slice_bytes();
  }
  std::uint64_t slice_bytes() const {
    return static_cast<std::uint64_t>(volume(slice.extent)) * scalar_bytes(facts.type->scalar);
  }
  std::unique_ptr<VolumeSource> from_raw(std::unique_ptr<InputFile> file, std::uint64_t offset) {
    const RawLayout layout{offset, facts.type->scalar, facts.type->big_endian, info.mapping};
    return make_raw_values(std::move(file), layout, std::move(info));
  }
  std::unique_ptr<VolumeSource> from_boxes(std::unique_ptr<StoredBoxes> boxes) {
    return make_stored_box_source(std::move(boxes), std::move(info), facts.type->big_endian, options.memory,
                                  object.where());
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
  for (std::size_t i = 0; i < opening.slice.index.size(); ++i) {
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
  auto boxes = make_external_boxes(std::move(parts), opening.slice.extent, scalar_bytes(opening.facts.type->scalar),
                                   first, opening.options.direct_io);
  return opening.from_boxes(std::move(boxes));
}

std::unique_ptr<VolumeSource> open_chunked(Opening opening) {
  const hid_t dataset = opening.object.handle.get();
  if (!ChunkReader::decodes(dataset)) {
    return opening.from_boxes(make_library_boxes(std::move(opening.object.handle), *opening.facts.storage,
                                                 opening.slice.index, opening.object.where()));
  }
  ChunkedSlice slice{dataset,
                     opening.object.where(),
                     opening.slice.index,
                     opening.facts.type->scalar,
                     opening.facts.type->big_endian,
                     opening.info.mapping,
                     opening.facts.storage->fill};
  return std::make_unique<ChunkedSource>(std::move(opening.object.handle), std::move(slice), std::move(opening.info),
                                         opening.options.memory);
}

std::unique_ptr<VolumeSource> open_stored(Opening opening) {
  switch (opening.facts.storage->kind) {
    case StorageKind::contiguous:
      return open_contiguous(std::move(opening));
    case StorageKind::external:
      return open_external(std::move(opening));
    case StorageKind::chunked:
      return open_chunked(std::move(opening));
    case StorageKind::compact:
      return opening.from_boxes(make_library_boxes(std::move(opening.object.handle), *opening.facts.storage,
                                                   opening.slice.index, opening.object.where()));
    case StorageKind::mapped:
      break;
  }
  const std::string parent = file_of(opening.object.handle.get());
  auto boxes = make_virtual_boxes(std::move(opening.object.handle), opening.slice.index, opening.slice.extent, parent,
                                  opening.object.where());
  std::vector<std::string> files = boxes->files();
  files.push_back(parent);
  opening.note_files(files);
  return opening.from_boxes(std::move(boxes));
}

// The array's bytes, leading axes included, fit 63 bits.
void check_bytes(const Opening& opening) {
  std::uint64_t bytes =
      checked_volume_bytes(opening.slice.extent, scalar_bytes(opening.facts.type->scalar), opening.object.where());
  for (std::size_t i = 0; i < opening.slice.index.size(); ++i) {
    const auto extent = static_cast<std::uint64_t>(opening.facts.axes[i].extent);
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
  if (opening.options.missing) info.mapping.missing.push_back(*opening.options.missing);
  info.spacing = opening.slice.spacing;
  info.origin = opening.slice.origin;
  info.file_bytes = file.size();
  info.mtime_ns = file.mtime_ns();
  return info;
}

}  // namespace

std::unique_ptr<VolumeSource> open_hdf5(const std::string& path, const SourceOptions& options) {
  const Hdf5Lock lock;
  const Hdf5Handle file = open_hdf5_file(path);
  Opening opening{options.dataset.empty() ? only_volume(file.get(), path, options.index.size())
                                          : find_dataset(file.get(), path, options.dataset),
                  {},
                  {},
                  {},
                  options};
  const std::string where = opening.object.where();
  opening.facts = dataset_facts(file.get(), opening.object);
  if (!opening.facts.obstacle.empty()) throw Error(ErrorKind::input, cat(where, ": ", opening.facts.obstacle));
  opening.slice = volume_slice(opening.facts.axes, options.index, where);
  check_bytes(opening);
  opening.info = source_info(path, opening);
  opening.note_files({file_of(opening.object.handle.get())});
  if (opening.facts.constant) return make_constant_source(*opening.facts.constant, std::move(opening.info));
  return open_stored(std::move(opening));
}

}  // namespace weir
