// What headers over raw values have in common, NRRD, MetaImage and NIfTI: an
// array in this file or another one, plain or as one compressed stream.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/files/input_file.h"
#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// An array as its header describes it; nothing of it is checked yet.
struct HeaderVolume {
  /// Of the header's file: path, format, bytes, time and state; labels, units, spacing, origin and mapping. The rest is
  /// filled in on opening, and the time becomes that of the values' file where that is later.
  SourceInfo info;
  std::vector<std::int64_t> extents;  ///< of every axis, the fastest first; those after the third choose a volume
  ScalarType type = ScalarType::float32;
  bool big_endian = false;

  std::string data_path;            ///< of the file with the values, perhaps the header's own
  std::uint64_t data_offset = 0;    ///< bytes before the values or, where they are packed, the compressed stream
  std::string offset_key;           ///< what the format calls data_offset, "HeaderSize"
  bool at_end = false;              ///< the values are the file's last bytes, at data_offset or after it
  bool ends_file = false;           ///< nothing may follow values in the header's own file
  bool packed = false;              ///< one gzip or zlib stream
  std::uint64_t packed_bytes = 0;   ///< of that stream; 0: to the end of the file
  std::uint64_t packed_offset = 0;  ///< unpacked bytes before the values

  std::vector<std::pair<std::string, std::string>> attributes;  ///< for the listing, besides spacing and origin
};

/// The file of the values, volume.data_path. Throws as InputFile, naming the header too where it is another file.
std::unique_ptr<InputFile> open_data_file(const HeaderVolume& volume, DirectIo mode);

/// Opens the volume at options.index. A packed one is unpacked here, once. Throws Error(usage) where the index does
/// not fit the axes after the third (it may be left out where each of those has one position), Error(input) where
/// an extent is impossible, the data file missing or too short, or, where it is the header's own, longer by a plane of
/// the volume or by more than 4096 bytes; and what spool_inflated throws. That the file has more bytes is said in
/// details.data_note: another file may hold other arrays too, and the header's own may end in a line end or padding.
/// A packed stream must unpack to exactly what the header says.
std::unique_ptr<VolumeSource> open_header_volume(const HeaderVolume& volume, const SourceOptions& options);

/// The same checks but for options.index and the packed bytes, and what there is.
std::vector<DatasetInfo> list_header_volume(const HeaderVolume& volume);

}  // namespace weir
