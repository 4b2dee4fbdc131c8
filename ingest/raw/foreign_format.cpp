#include "ingest/raw/foreign_format.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kAnyArray = "convert it to raw, HDF5, Zarr, NRRD or NIfTI";

/// A format that is recognised by bytes at `offset` in the file.
struct MarkedFormat {
  std::string_view magic;
  std::uint64_t offset;  ///< offset of `magic` in the file
  std::string_view name;
};
constexpr std::array<MarkedFormat, 6> kMarked{{{{"II*\0", 4}, 0, "a TIFF file"},
                                               {{"MM\0*", 4}, 0, "a TIFF file"},
                                               {{"II+\0", 4}, 0, "a BigTIFF file"},
                                               {{"MM\0+", 4}, 0, "a BigTIFF file"},
                                               {"DICM", 128, "a DICOM file"},
                                               {"MAP ", 208, "an MRC file"}}};

/// A format that is recognised by the suffix of its name.
struct NamedFormat {
  std::string_view suffix;
  std::string_view name;
  std::string_view remedy;
};
constexpr std::string_view kFreeSurfer = "a volume of FreeSurfer";
constexpr std::string_view kToNifti = "convert it to NIfTI with mri_convert";
constexpr std::string_view kXdmf = "an XDMF file";
constexpr std::string_view kArraysOfXdmf = "name the HDF5 file that its arrays lie in";
constexpr std::array<NamedFormat, 5> kNamed{
    {{".mgz", kFreeSurfer, kToNifti},
     {".mgh", kFreeSurfer, kToNifti},
     {".pvti", "a parallel VTK image", "write it as one .vti file, or name one of its pieces"},
     {".xdmf", kXdmf, kArraysOfXdmf},
     {".xmf", kXdmf, kArraysOfXdmf}}};

// Returns `count` bytes at `offset`, or "" if the file ends before.
std::string bytes_at(InputFile& file, std::uint64_t offset, std::size_t count) {
  if (file.size() < offset + count) return {};
  std::string bytes(count, '\0');
  file.read_buffered(offset, std::as_writable_bytes(std::span(bytes)), ReadPath::through);
  return bytes;
}

// Returns whether the file is an image header: its first four bytes are its length, 348 (NIfTI-1, Analyze 7.5) or 540
// (NIfTI-2), in either byte order.
bool is_image_header(const std::string& path) {
  InputFile file(path, DirectIo::off);
  const std::string begin = bytes_at(file, 0, 4);
  constexpr std::array<std::string_view, 4> kLengths{
      {{"\x5C\1\0\0", 4}, {"\0\0\1\x5C", 4}, {"\x1C\2\0\0", 4}, {"\0\0\2\x1C", 4}}};
  return std::ranges::find(kLengths, begin) != kLengths.end();
}

// Returns the header beside an image: "brain.hdr" for "brain.img".
std::optional<std::string> image_header_of(const std::string& path) {
  if (!lower_case(path).ends_with(".img")) return std::nullopt;
  for (const char* const suffix : {".hdr", ".HDR"}) {
    const std::string header = std::filesystem::path(path).replace_extension(suffix).string();
    std::error_code unknown;
    if (std::filesystem::is_regular_file(header, unknown) && std::filesystem::file_size(header, unknown) > 0 &&
        is_image_header(header)) {
      return header;
    }
  }
  return std::nullopt;
}

Error refused(const InputFile& file, std::string_view name, std::string_view remedy) {
  return input_error(file.path(), cat("is ", name, ", which weir does not read; ", remedy));
}

}  // namespace

void refuse_foreign_format(InputFile& file) {
  if (const auto header = image_header_of(file.path())) {
    throw input_error(file.path(), cat("has the values of an image whose header is ", *header, "; give that instead"));
  }
  for (const MarkedFormat& format : kMarked) {
    if (bytes_at(file, format.offset, format.magic.size()) == format.magic) {
      throw refused(file, format.name, kAnyArray);
    }
  }
  const std::string path = lower_case(file.path());
  for (const NamedFormat& format : kNamed) {
    if (path.ends_with(format.suffix)) throw refused(file, format.name, format.remedy);
  }
}

}  // namespace weir
