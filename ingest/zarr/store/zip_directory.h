// Reads the directory of a zip file: its entries and their places (PKWARE, APPNOTE.TXT, with the 64-bit fields).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace weir {

/// One entry of a zip file.
struct ZipEntry {
  std::uint64_t header = 0;  ///< offset of its local header
  std::uint64_t packed = 0;  ///< bytes as packed in the file
  std::uint64_t bytes = 0;   ///< bytes after unpacking
  std::uint32_t crc = 0;     ///< CRC-32 of the unpacked bytes
  std::uint16_t method = 0;  ///< kZipStored, kZipDeflated, or another
  bool encrypted = false;
};

inline constexpr std::uint16_t kZipStored = 0;
inline constexpr std::uint16_t kZipDeflated = 8;

/// Access to a file's bytes: `read` fills a span from an offset on. The span must lie below `size`.
struct ZipBytes {
  std::uint64_t size = 0;
  std::function<void(std::uint64_t offset, std::span<std::byte> into)> read;
};

/// Entries by name. If several have one name, the last is kept, as zip's own tools do. Names that end with a slash
/// are left out.
using ZipEntries = std::map<std::string, ZipEntry, std::less<>>;

/// Memory for one entry without its name, in bytes.
inline constexpr std::uint64_t kZipEntryBytes = 160;

/// Returns whether a file with the first bytes `head` begins with an entry or, in an empty zip file, with the end
/// record.
bool begins_as_zip(std::span<const std::byte> head);

/// Reads the directory of a zip file. Throws Error(input), beginning with `where`, if the file is not a zip file, has
/// several parts or is damaged. Throws Error(usage) if the directory needs more than `memory` bytes, before it
/// allocates them.
ZipEntries read_zip_directory(const ZipBytes& file, std::uint64_t memory, const std::string& where);

/// Returns the offset of the first packed byte of the entry `name`. Throws Error(input) if its local header is
/// missing or belongs to another entry, or if its bytes reach beyond the end of the file.
std::uint64_t zip_entry_begin(const ZipBytes& file, std::string_view name, const ZipEntry& entry,
                              const std::string& where);

}  // namespace weir
