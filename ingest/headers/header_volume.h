// The common part of formats with a header and raw values: NRRD, MetaImage and NIfTI. The values are an array in the
// header's file or another file, plain or as one compressed stream.
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

/// An array as its header describes it. Nothing is checked against files yet.
struct HeaderVolume {
  /// Of the header's file: path, format, bytes, time and state; also labels, units, spacing, origin and mapping.
  /// Opening fills in the rest, and takes the time of the values' file if it is later.
  SourceInfo info;
  std::vector<std::int64_t> extents;  ///< of every axis, fastest first; the axes after the third choose a volume
  ScalarType type = ScalarType::float32;
  bool big_endian = false;

  std::string data_path;            ///< file with the values, perhaps the header's own
  std::uint64_t data_offset = 0;    ///< bytes before the values or, if they are packed, before the compressed stream
  std::string offset_key;           ///< the format's name for data_offset, "HeaderSize"
  bool at_end = false;              ///< the values are the file's last bytes, at data_offset or after it
  bool ends_file = false;           ///< nothing may follow the values in the header's own file
  bool packed = false;              ///< the values are one gzip or zlib stream
  std::uint64_t packed_bytes = 0;   ///< bytes of the stream; 0: to the end of the file
  std::uint64_t packed_offset = 0;  ///< unpacked bytes before the values

  std::vector<std::pair<std::string, std::string>> attributes;  ///< for the listing, besides spacing and origin
};

/// Opens the file of the values, volume.data_path. Throws the errors of InputFile, and names the header too if it is
/// another file.
std::unique_ptr<InputFile> open_data_file(const HeaderVolume& volume, DirectIo mode);

/// Opens the volume at options.index. Unpacks a packed volume here, once; the stream must unpack to exactly the size
/// that the header says. Throws Error(usage) if the index does not fit the axes after the third (it may be left out
/// if each of these has one position). Throws Error(input) if an extent is impossible, or if the data file is missing
/// or too short. If the data file is the header's own, it must not be longer by a plane of the volume or by more than
/// 4096 bytes. Also throws the errors of spool_inflated. details.data_note says if the file has more bytes: another
/// file may hold other arrays too, and the header's own may end in a line end or padding.
std::unique_ptr<VolumeSource> open_header_volume(const HeaderVolume& volume, const SourceOptions& options);

/// Makes the same checks, except of options.index and the packed bytes, and describes the array.
std::vector<DatasetInfo> list_header_volume(const HeaderVolume& volume);

}  // namespace weir
