#include "ingest/hdf5/filters/library_lzf.h"

#include <cstddef>
#include <exception>
#include <span>

#include "ingest/hdf5/filters/undo_filters.h"

namespace weir {
namespace {

constexpr std::size_t kChunkBytesAt = 2;  // in the filter's parameters, as h5py writes them

// An H5Z_func_t; 0 means failure. It fails on writing, because it only decodes: the library then stores the chunk
// without lzf.
std::size_t undo_lzf(unsigned flags, std::size_t parameters, const unsigned* parameter, std::size_t stored,
                     std::size_t* room, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0 || parameters <= kChunkBytesAt) return 0;
  const std::size_t bytes = parameter[kChunkBytesAt];
  void* const unpacked = H5allocate_memory(bytes, false);
  if (unpacked == nullptr) return 0;
  try {
    unpack_lzf({static_cast<const std::byte*>(*buffer), stored}, {static_cast<std::byte*>(unpacked), bytes});
  } catch (const std::exception&) {  // no exception may pass through the library
    H5free_memory(unpacked);
    return 0;
  }
  H5free_memory(*buffer);
  *buffer = unpacked;
  *room = bytes;
  return bytes;
}

// Returns whether the library has weir's decoder; it is recognised because it has no encoder.
bool is_offered() {
  unsigned how = 0;
  return H5Zget_filter_info(kLzfFilter, &how) >= 0 && (how & H5Z_FILTER_CONFIG_ENCODE_ENABLED) == 0;
}

}  // namespace

void offer_lzf() {
  unsigned how = 0;
  if (H5Zget_filter_info(kLzfFilter, &how) >= 0) return;  // known already; this call looks for no plugin
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kLzfFilter, 0, 1, "lzf", nullptr, nullptr, undo_lzf};
  H5Zregister(&filter);
}

bool library_undoes(H5Z_filter_t id) { return H5Zfilter_avail(id) > 0 && !(id == kLzfFilter && is_offered()); }

}  // namespace weir
