#include "ingest/hdf5/filters/filter_names.h"

#include <algorithm>
#include <array>

#include "format/base/text.h"
#include "ingest/hdf5/filters/library_lzf.h"

namespace weir {
namespace {

struct FilterEntry {
  H5Z_filter_t id;
  std::string_view name;
  std::string_view package;  ///< the package in Debian and Ubuntu; empty if there is none
};

// The HDF Group's registry of filters.
constexpr std::array kFilters{
    FilterEntry{H5Z_FILTER_DEFLATE, "gzip", ""},
    FilterEntry{H5Z_FILTER_SHUFFLE, "shuffle", ""},
    FilterEntry{H5Z_FILTER_FLETCHER32, "fletcher32", ""},
    FilterEntry{H5Z_FILTER_SZIP, "szip", ""},
    FilterEntry{H5Z_FILTER_NBIT, "nbit", ""},
    FilterEntry{H5Z_FILTER_SCALEOFFSET, "scaleoffset", ""},
    FilterEntry{305, "lzo", ""},
    FilterEntry{307, "bzip2", "hdf5-filter-plugin"},
    FilterEntry{kLzfFilter, "lzf", ""},
    FilterEntry{32001, "blosc", "hdf5-filter-plugin-blosc-serial"},
    FilterEntry{32004, "lz4", "hdf5-filter-plugin"},
    FilterEntry{32008, "bitshuffle", "bitshuffle"},
    FilterEntry{32013, "zfp", "hdf5-filter-plugin-zfp-serial"},
    FilterEntry{32015, "zstd", ""},
    FilterEntry{32017, "sz", ""},
    FilterEntry{32024, "sz3", ""},
    FilterEntry{32026, "blosc2", ""},
    FilterEntry{32028, "sperr", ""},
};

const FilterEntry* entry_of(H5Z_filter_t id) {
  const auto* const found = std::ranges::find(kFilters, id, &FilterEntry::id);
  return found == kFilters.end() ? nullptr : found;
}

}  // namespace

std::string filter_name(H5Z_filter_t id, std::string_view stored) {
  if (const FilterEntry* entry = entry_of(id)) return std::string(entry->name);
  return stored.empty() ? cat("filter ", id) : std::string(stored);
}

std::string filter_remedy(H5Z_filter_t id) {
  const FilterEntry* const entry = entry_of(id);
  const std::string install =
      entry != nullptr && !entry->package.empty() ? cat("install the package ", entry->package, ", or ") : "";
  return install + "set HDF5_PLUGIN_PATH to the directory that has it";
}

}  // namespace weir
