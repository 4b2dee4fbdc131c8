#include "ingest/hdf5/file/hdf5_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/drivers/hdf5_signature.h"
#include "ingest/files/input_file.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

// The most attempts to read metadata that a writer has half written. Between them the library sleeps 1, 2, 4 ... ns, a
// quarter of a second in all. With its default of 100 attempts, reading a damaged file would practically never end.
constexpr unsigned kReadAttempts = 28;

// Readers ask for each decoded chunk once, so they need no chunk cache. The metadata cache is bounded.
Hdf5Handle access_properties() {
  Hdf5Handle properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_cache(properties.get(), 0, 0, 0, 0.0);
  H5AC_cache_config_t metadata{};
  metadata.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  if (H5Pget_mdc_config(properties.get(), &metadata) >= 0) {
    metadata.set_initial_size = true;
    metadata.initial_size = kHdf5MetadataBytes / 4;
    metadata.min_size = kHdf5MetadataBytes / 4;
    metadata.max_size = kHdf5MetadataBytes;
    H5Pset_mdc_config(properties.get(), &metadata);
  }
  return properties;
}

Error refused(const std::string& path, const std::string& reason) {
  const auto says = [&](std::string_view part) { return reason.find(part) != std::string::npos; };
  const auto error = [&](const auto&... text) { return Error(ErrorKind::input, cat(path, ": ", text...)); };
  if (says("unable to lock file")) {
    if (says("errno = 11,")) {  // EAGAIN: another process holds it
      return error(
          "locked by a program that has it open for writing; wait until that closes it or writes for readers "
          "(SWMR), or, where no program has it open, set HDF5_USE_FILE_LOCKING=FALSE");
    }
    return error("the file system refuses to lock it (", reason, "); set HDF5_USE_FILE_LOCKING=FALSE");
  }
  if (says("already open for write")) {
    return error(
        "marked as open for writing, and not for readers beside (SWMR): a program still writes it or died at it; wait "
        "until it is closed, or clear the mark with h5clear -s");
  }
  unsigned long long size = 0;
  unsigned long long base = 0;
  unsigned long long stored = 0;
  if (std::sscanf(reason.c_str(), "truncated file: eof = %llu, sblock->base_addr = %llu, stored_eof = %llu", &size,
                  &base, &stored) == 3) {
    return error("cut short: it has ", size, " bytes and says it has ", base + stored,
                 "; copy it again, or wait until it is written");
  }
  return error("cannot be opened as HDF5 (", reason, "); the file is damaged or still being written");
}

}  // namespace

Hdf5Handle open_hdf5_file(const std::string& path) {
  std::array<std::byte, 4> head{};
  InputFile file(path, DirectIo::off);
  const auto read = std::span(head).first(std::min<std::uint64_t>(head.size(), file.size()));
  file.read_buffered(0, read, ReadPath::through);
  if (is_classic_netcdf(read)) {
    throw Error(ErrorKind::input,
                cat(path, ": NetCDF of before version 4, which is not HDF5; convert it with nccopy -k nc4"));
  }
  if (!has_hdf5_signature(path)) {
    throw Error(ErrorKind::input, cat(path, ": no HDF5 signature at 0, 512, 1024 ...", kNotAsNamed));
  }
  const Hdf5Handle properties = access_properties();
  Hdf5Handle opened(H5Fopen(path.c_str(), H5F_ACC_RDONLY, properties.get()));
  if (opened) return opened;
  // If a writer has opened the file for simultaneous readers (SWMR), all opens in this process must ask for SWMR.
  const std::string reason = hdf5_reason();
  if (reason.find("open for write") != std::string::npos || reason.find("SWMR") != std::string::npos) {
    H5Pset_metadata_read_attempts(properties.get(), kReadAttempts);
    opened = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, properties.get()));
    if (opened) return opened;
  }
  throw refused(path, reason);
}

}  // namespace weir
