// Finds or decodes the values of one array of a VTK XML file.
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

/// Unencoded values in a file.
struct PlainValues {
  std::unique_ptr<InputFile> file;
  std::uint64_t offset = 0;  ///< of the first
  bool big_endian = false;
};

/// Returns the `bytes` bytes of `array`: in `file` if they are stored there unencoded, otherwise decoded into a spool
/// file. Throws Error(input), beginning with `where`, if the data has another size or is damaged, Error(usage) if
/// options.memory does not hold the list of compressed blocks, and the errors of SpoolFile.
PlainValues plain_vtk_values(std::unique_ptr<InputFile> file, const VtkXmlHeader& header, const VtkXmlArray& array,
                             std::uint64_t bytes, const SourceOptions& options, const std::string& where);

/// Reads the few bytes of an array that is not text into memory. `values` has exactly the array's size and receives
/// the values in the file's byte order.
void read_vtk_values(InputFile& file, const VtkXmlHeader& header, const VtkXmlArray& array, std::span<std::byte> values,
                     const std::string& where);

}  // namespace weir
