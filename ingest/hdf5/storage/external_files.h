// Reads datasets that keep their values in external files. weir reads the files itself because the library silently
// reads missing parts as zeros.
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
  std::uint64_t bytes = 0;  ///< of the dataset in this file
};

/// Returns the files that hold the `bytes` bytes of a dataset, in order. side_file_places() finds them with
/// HDF5_EXTFILE_PREFIX and `parent`, the file that names them. Throws Error(input), beginning with `where`, if a file
/// is missing or too short. The caller holds Hdf5Lock.
std::vector<ExternalPart> external_parts(hid_t creation, std::uint64_t bytes, const std::string& parent,
                                         const std::string& where);

/// Returns a volume of `extent` values of `value_bytes` each. The volume begins `first_byte` bytes into the parts'
/// values.
std::unique_ptr<StoredBoxes> make_external_boxes(std::vector<ExternalPart> parts, const Index3& extent,
                                                 std::size_t value_bytes, std::uint64_t first_byte, DirectIo mode);

}  // namespace weir
