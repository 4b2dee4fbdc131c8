#include "ingest/vtk/vtk_xml_time.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/values/decode_doubles.h"
#include "ingest/vtk/vtk_xml_data.h"

namespace weir {
namespace {

constexpr std::uint64_t kMostTimeText = 4096;  // with white space around the number

double time_in_text(InputFile& file, const VtkXmlArray& array, const std::string& where) {
  const std::uint64_t length = array.end - array.begin;
  if (length > kMostTimeText) {
    throw Error(ErrorKind::input, cat(where, ": its text has ", length, " characters, and at most ", kMostTimeText,
                                      " are read for one number"));
  }
  std::string text(static_cast<std::size_t>(length), '\0');
  file.read_buffered(array.begin, std::as_writable_bytes(std::span(text)), ReadPath::through);
  if (const auto numbers = parse_doubles(text); numbers && numbers->size() == 1) return numbers->front();
  throw Error(ErrorKind::input, cat(where, ": its text is ", in_quotes(trimmed(text)), ", not one number"));
}

double time_value(InputFile& file, const VtkXmlHeader& header) {
  const VtkXmlArray& array = *header.time;
  const std::string where = cat(file.path(), ": array 'TimeValue' of its field data");
  if (!array.obstacle.empty() && array.name.empty()) throw Error(ErrorKind::input, array.obstacle);
  if (!array.obstacle.empty()) throw Error(ErrorKind::input, cat(where, ": ", array.obstacle));
  if (array.format == VtkXmlArray::Format::ascii) return time_in_text(file, array, where);
  std::array<std::byte, sizeof(double)> buffer{};
  const auto bytes = std::span(buffer).first(scalar_bytes(array.type));
  read_vtk_values(file, header, array, bytes, where);
  return decode_doubles(bytes, array.type, header.big_endian, {}).front();
}

}  // namespace

std::optional<TimePoint> vtk_xml_time(InputFile& file, const VtkXmlHeader& header, const SourceOptions& options) {
  if (!header.time) return std::nullopt;
  try {
    const double value = time_value(file, header);
    if (std::isfinite(value)) return TimePoint{value, {}, {}};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    if (options.notice) options.notice(compose(error.message(), ": the volume's time is left out"));
  }
  return std::nullopt;
}

}  // namespace weir
