// Datasets whose values lie in files of their own. Read here and not by the
// library, which takes what is missing in them for zeros.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ingest/files/input_file.h"
#include "ingest/hdf5/storage/stored_boxes.h"

namespace weir {

struct ExternalPart {
  std::string path;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< of the dataset in it
};

/// The files that hold the `bytes` bytes of a dataset, in order, found by side_file_places with HDF5_EXTFILE_PREFIX
/// and `parent`, the file that names them. Throws Error(input), beginning with `where`, where one is missing or too
/// short. The caller holds Hdf5Lock.
std::vector<ExternalPart> external_parts(hid_t creation, std::uint64_t bytes, const std::string& parent,
                                         const std::string& where);

/// A volume of `extent` values of `value_bytes` each, which begins `first_byte` bytes into the parts' values.
std::unique_ptr<StoredBoxes> make_external_boxes(std::vector<ExternalPart> parts, const Index3& extent,
                                                 std::size_t value_bytes, std::uint64_t first_byte, DirectIo mode);

}  // namespace weir
