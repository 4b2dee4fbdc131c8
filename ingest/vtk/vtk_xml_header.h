// Parses the description in a VTK XML image file (.vti):
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/vtk/vtk_array.h"
#include "ingest/vtk/vtk_image.h"
#include "ingest/vtk/vtk_xml_skeleton.h"

namespace weir {

struct VtkXmlArray : VtkArray {
  enum class Format { ascii, binary, appended };

  Format format = Format::ascii;
  std::uint64_t begin = 0;  ///< of the text in the file, or in the appended data
  std::uint64_t end = 0;    ///< of the text in the file; 0 for appended data
};

struct VtkXmlHeader {
  bool big_endian = false;
  std::size_t word_bytes = 4;  ///< of the sizes before the data: 4 or 8
  bool zlib = false;
  std::optional<std::uint64_t> appended;  ///< first byte of the appended data in the file
  bool appended_base64 = false;
  VtkImage image;
  std::vector<VtkXmlArray> arrays;
  std::optional<VtkXmlArray> time;  ///< TimeValue of the field data, one number
  std::string scalars;              ///< name of the array that the file marks as its scalars; empty if none
};

/// Reads the markup of one piece of image data. Pure. Throws Error(input), beginning with `path` and naming element
/// and value, if the file is no such file or describes data that weir does not read: other kinds of data, several
/// pieces, other compressors. An array that weir does not read gets an `obstacle`.
VtkXmlHeader parse_vtk_xml_header(const VtkXmlSkeleton& skeleton, const std::string& path);

}  // namespace weir
