// The values of one array of a VTK XML file, found or decoded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ingest/files/input_file.h"
#include "ingest/source/source_options.h"
#include "ingest/vtk/vtk_xml_header.h"

namespace weir {

/// Plain values in a file.
struct PlainValues {
  std::unique_ptr<InputFile> file;
  std::uint64_t offset = 0;  ///< of the first
  bool big_endian = false;
};

/// The `bytes` bytes of `array`: in `file` where they lie there as they are, else decoded into a spool file. Throws
/// Error(input), beginning with `where`, where what is there is of another size or damaged; Error(usage) where
/// options.memory does not hold the list of compressed blocks; what SpoolFile throws.
PlainValues plain_vtk_values(std::unique_ptr<InputFile> file, const VtkXmlHeader& header, const VtkXmlArray& array,
                             std::uint64_t bytes, const SourceOptions& options, const std::string& where);

/// The same of an array that is not text, a few bytes, into memory: `values` holds exactly them, in the file's byte
/// order.
void read_vtk_values(InputFile& file, const VtkXmlHeader& header, const VtkXmlArray& array, std::span<std::byte> values,
                     const std::string& where);

}  // namespace weir
