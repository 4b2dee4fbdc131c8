// A virtual dataset's mappings: which elements of it lie where in which other
// dataset. The library silently reads what it cannot find as fill values; here every source is found, or named in an
// error, and elements that no source is mapped to are counted, and chunks that a source lacks.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/virtual/coverage.h"

namespace weir {

/// Elements of one source dataset, which has been found and looked at.
struct VirtualMapping {
  std::string file;             ///< path; empty: the virtual dataset's own
  std::string dataset;          ///< inside it
  Hdf5Handle in_source;         ///< space of the source dataset, its elements selected
  Hdf5Handle in_virtual;        ///< space of the virtual dataset, as many elements selected
  AxisBox bounds;               ///< of the elements in the virtual dataset
  std::vector<hsize_t> chunk;   ///< of the source dataset, slowest axis first; empty where it has none
  std::size_t value_bytes = 0;  ///< of the source's type
  bool all_fill = false;        ///< no value was ever written to the source, and all are its fill value
};

/// Chunks of sources that elements of the volume lie in and that nobody has written: the library gives the source's
/// fill value for them. A source without chunks counts as one.
struct UnwrittenInSources {
  std::uint64_t count = 0;  ///< once for each mapping that reads it
  std::string first;        ///< "0, 0, 8 of PATH: DATASET"; empty where it was not looked up

  void add(const UnwrittenInSources& further);
};

struct VirtualMappings {
  std::vector<VirtualMapping> mappings;
  Uncovered unmapped;  ///< elements that the library gives the fill value for
  UnwrittenInSources unwritten;
};

/// Of a virtual dataset: a volume, or a region of one, which may lie where there are no sources.
struct WantedElements {
  AxisBox box;
  bool need_a_source = true;
};

/// The mappings of `dataset` (in the file `parent`) that have elements in `wanted`, in the file's order; those
/// that go on without end are cut to what there is, those with a block number in the source's name become one
/// for each block. Every source is opened once and closed again. Throws Error(input), beginning with `where`:
/// naming the source where it is missing, too small, never written and without a fill value of its writer, behind a
/// missing filter, or itself spread over files; and where none of `wanted` has a source that it needs. The caller holds
/// Hdf5Lock.
VirtualMappings virtual_mappings(hid_t dataset, const WantedElements& wanted, const std::string& parent,
                                 const std::string& where);

/// The source dataset of a mapping. Throws as above. The caller holds Hdf5Lock.
Hdf5Handle open_virtual_source(hid_t virtual_dataset, const std::string& file, const std::string& dataset,
                               const std::string& where);

/// A source's name as the file has it, with `block` in place of each %b, and % for %%.
std::string virtual_source_name(const std::string& stored, std::uint64_t block);

}  // namespace weir
