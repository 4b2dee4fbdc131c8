// Which entries a zip file has, and where in it they lie (PKWARE, APPNOTE.TXT, with the fields of 64 bits).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace weir {

/// One file in a zip file.
struct ZipEntry {
  std::uint64_t header = 0;  ///< offset of its local header
  std::uint64_t packed = 0;  ///< bytes in the file
  std::uint64_t bytes = 0;   ///< unpacked
  std::uint32_t crc = 0;     ///< CRC-32 of the unpacked bytes
  std::uint16_t method = 0;  ///< kZipStored, kZipDeflated, or another
  bool encrypted = false;
};

inline constexpr std::uint16_t kZipStored = 0;
inline constexpr std::uint16_t kZipDeflated = 8;

/// A file's bytes: `read` fills a span from an offset on, all of which lies below `size`.
struct ZipBytes {
  std::uint64_t size = 0;
  std::function<void(std::uint64_t offset, std::span<std::byte> into)> read;
};

/// By name; of several with one name the last, as zip's own tools have it. Names that end with a slash are left out.
using ZipEntries = std::map<std::string, ZipEntry, std::less<>>;

/// Memory for one entry, its name aside, in bytes.
inline constexpr std::uint64_t kZipEntryBytes = 160;

/// Whether a file whose first bytes are `head` begins with an entry or, empty, with the end record.
bool begins_as_zip(std::span<const std::byte> head);

/// Throws Error(input), beginning with `where`, where the file is no zip file, in several parts or damaged, and
/// Error(usage) where the directory takes more than `memory` bytes, before any is taken.
ZipEntries read_zip_directory(const ZipBytes& file, std::uint64_t memory, const std::string& where);

/// Offset of the first byte of the packed bytes of the entry `name`. Throws Error(input) where its local header is none
/// or another entry's, or the bytes reach beyond the file.
std::uint64_t zip_entry_begin(const ZipBytes& file, std::string_view name, const ZipEntry& entry,
                              const std::string& where);

}  // namespace weir
