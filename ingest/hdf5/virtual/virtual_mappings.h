// The mappings of a virtual dataset: where each of its elements lies in another dataset. The library silently reads
// what it cannot find as fill values. weir instead finds every source or names it in an error, and counts the
// elements without a source and the chunks that a source lacks.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/virtual/coverage.h"

namespace weir {

/// Elements of one source dataset, which has been found and checked.
struct VirtualMapping {
  std::string file;             ///< path; empty: the virtual dataset's own
  std::string dataset;          ///< inside it
  Hdf5Handle in_source;         ///< space of the source dataset, its elements selected
  Hdf5Handle in_virtual;        ///< space of the virtual dataset, as many elements selected
  AxisBox bounds;               ///< of the elements in the virtual dataset
  std::vector<hsize_t> chunk;   ///< of the source dataset, slowest axis first; empty if it is not chunked
  std::size_t value_bytes = 0;  ///< of the source's type
  bool all_fill = false;        ///< no value was ever written to the source: all read as its fill value
};

/// Unwritten chunks of sources that hold elements of the volume. The library reads them as the source's fill value. A
/// source without chunks counts as one chunk.
struct UnwrittenInSources {
  std::uint64_t count = 0;  ///< a chunk counts once for each mapping that reads it
  std::string first;        ///< "0, 0, 8 of PATH: DATASET"; empty if it was not looked up

  void add(const UnwrittenInSources& further);
};

struct VirtualMappings {
  std::vector<VirtualMapping> mappings;
  Uncovered unmapped;  ///< elements that the library gives the fill value for
  UnwrittenInSources unwritten;
};

/// The elements of a virtual dataset that are read: a volume, or a region of it, which may lie where there are no
/// sources.
struct WantedElements {
  AxisBox box;
  bool need_a_source = true;
};

/// Returns the mappings of `dataset` (in the file `parent`) that have elements in `wanted`, in the file's order.
/// Unlimited mappings are cut to the existing extent. A mapping with a block number in the source's name becomes one
/// mapping for each block. Every source is opened once and closed again. Throws Error(input), beginning with `where`,
/// if a source (which the message names) is missing, too small, never written and without a fill value of its writer,
/// behind a missing filter, or itself spread over files. Throws it too if no element of `wanted` has a source and
/// `need_a_source` is set. The caller holds Hdf5Lock.
VirtualMappings virtual_mappings(hid_t dataset, const WantedElements& wanted, const std::string& parent,
                                 const std::string& where);

/// Opens the source dataset of a mapping. Throws like virtual_mappings(). The caller holds Hdf5Lock.
Hdf5Handle open_virtual_source(hid_t virtual_dataset, const std::string& file, const std::string& dataset,
                               const std::string& where);

/// Returns a source's name from the text `stored` in the file, with `block` for each %b, and % for %%.
std::string virtual_source_name(const std::string& stored, std::uint64_t block);

}  // namespace weir
