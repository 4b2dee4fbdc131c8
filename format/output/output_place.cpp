#include "format/output/output_place.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"

namespace weir {
namespace {

// Extensions of formats that weir reads or writes, and of others that a volume or a picture may be meant to have.
constexpr std::array<std::string_view, 37> kOthersExtensions{
    ".cdf", ".csv", ".exr",  ".gz",   ".h5",  ".hdf", ".hdf5", ".he5",    ".jpeg", ".jpg",  ".json", ".mha", ".mhd",
    ".mp4", ".nc",  ".nc4",  ".nhdr", ".nii", ".npy", ".npz",  ".nrrd",   ".ozx",  ".pdf",  ".png",  ".ppm", ".raw",
    ".svg", ".tif", ".tiff", ".toml", ".txt", ".vti", ".vtk",  ".vtkhdf", ".vtu",  ".zarr", ".zip"};

}  // namespace

void require_place(FileSystem& files, const std::string& path, std::size_t beside) {
  constexpr std::size_t kLongestName = 255;  // bytes; NAME_MAX of Linux
  const std::string directory = directory_of(path);
  if (!files.exists(directory)) {
    throw Error(ErrorKind::io,
                cat(path, ": the directory ", directory, " does not exist; make it or choose another output"),
                SystemFailure{ENOENT, directory});
  }
  const std::size_t name = path.size() - (path.rfind('/') + 1);
  if (name + beside > kLongestName) {
    throw usage_error(cat(path, ": its name has ", name, " bytes, and with what weir writes beside it at most ",
                          kLongestName - beside, " can be used; choose a shorter one"));
  }
  if (!files.is_replaceable(path)) {
    throw usage_error(cat(path, ": is no regular file, and nothing else is replaced; choose another output"));
  }
}

Error existing_output(const std::string& path) {
  return usage_error(compose(path, ": exists; choose another output or pass ", option("overwrite")));
}

void refuse_existing(FileSystem& files, const std::string& path) {
  if (files.exists(path)) throw existing_output(path);
}

void require_volume_name(const std::string& path) {
  if (path == "-") {
    throw usage_error(
        "-: cannot write to standard output: the header is written last; name a file, and stream that when it is done");
  }
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || path.find('/', dot) != std::string::npos) return;
  const std::string extension = lower_case(path.substr(dot));
  const std::string volume = path.substr(0, dot) + ".nvdb";
  if (extension == ".vdb") {
    throw usage_error(cat(path, ": is to be a NanoVDB file, and .vdb is OpenVDB's; name it ", volume,
                          ", and make the OpenVDB file of that with weir export ", volume, " -o ", path));
  }
  if (std::ranges::find(kOthersExtensions, extension) == kOthersExtensions.end()) return;
  throw usage_error(cat(path, ": is to be a NanoVDB file, and ", extension, " is another format's; name it ", volume));
}

void require_alone(const File& partial) {
  if (partial.exclusive()) return;
  throw Error(ErrorKind::io, cat(partial.path(),
                                 ": exists, and files cannot be locked here, so that its writer may still be at work; "
                                 "remove it if there is none"));
}

void require_named(const File& written) {
  if (written.has_its_name()) return;
  throw Error(
      ErrorKind::io,
      cat(written.path(), ": was removed or replaced while it was written; let nobody remove it, and try again"),
      SystemFailure{ENOENT, written.path()});
}

void place_new(FileSystem& files, const std::string& written, const std::string& path) {
  try {
    files.rename_new(written, path);
  } catch (const Error& error) {
    if (!error.system_failure() || error.system_failure()->errno_value != EEXIST) throw;
    throw Error(ErrorKind::io,
                compose(path, ": appeared while it was written; choose another output or pass ", option("overwrite")),
                SystemFailure{EEXIST, path});
  }
}

void flush_name(FileSystem& files, const std::string& path) {
  try {
    files.sync_directory(directory_of(path));
  } catch (const Error& error) {
    throw Error(error.kind(),
                compose(path, ": is there and whole, but may be gone after a power failure: ", error.message()),
                error.system_failure());
  }
}

}  // namespace weir
