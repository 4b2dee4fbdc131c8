// libFuzzer target for the markup of .vti files. Any bytes must parse to a header with consistent parts, or throw
// Error(input) with a message of one line. The markup must be the same if the bytes arrive whole or in two halves.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "format/base/error.h"
#include "ingest/vectors/voxel_components.h"
#include "ingest/vtk/vtk_xml_header.h"

namespace {

void check(const weir::VtkXmlHeader& header, std::size_t size) {
  const weir::Index3& points = header.image.points;
  if (points.x < 1 || points.y < 1 || points.z < 1 || (header.word_bytes != 4 && header.word_bytes != 8)) std::abort();
  if (header.appended && *header.appended > size) std::abort();
  for (const weir::VtkXmlArray& array : header.arrays) {
    if (!array.obstacle.empty()) continue;
    if (!weir::components_obstacle(array.components).empty()) std::abort();
    if (array.format == weir::VtkXmlArray::Format::appended && !header.appended) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  try {
    weir::VtkXmlSkeleton whole("fuzz.vti");
    whole.push(input);
    weir::VtkXmlSkeleton parts("fuzz.vti");
    parts.push(input.substr(0, size / 2));
    parts.push(input.substr(size / 2));
    if (whole.xml() != parts.xml() || whole.appended() != parts.appended()) std::abort();
    check(weir::parse_vtk_xml_header(whole, "fuzz.vti"), size);
  } catch (const weir::Error& error) {
    const std::string_view message = error.what();
    if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
