#include "ingest/zarr/store/zip_directory.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::uint32_t kLocalMagic = 0x04034B50U;
constexpr std::uint32_t kCentralMagic = 0x02014B50U;
constexpr std::uint32_t kEndMagic = 0x06054B50U;
constexpr std::uint32_t kEnd64Magic = 0x06064B50U;
constexpr std::uint32_t kLocator64Magic = 0x07064B50U;
constexpr std::size_t kLocalBytes = 30;
constexpr std::size_t kCentralBytes = 46;
constexpr std::size_t kEndBytes = 22;
constexpr std::size_t kEnd64Bytes = 56;
constexpr std::size_t kLocator64Bytes = 20;
constexpr std::size_t kMostComment = 65535;
constexpr std::uint16_t kExtra64 = 1;             // id of the extra field that has 64-bit numbers
constexpr std::uint64_t kSeeExtra = 0xFFFFFFFFU;  // in place of a number that is in the extra field

std::uint64_t little_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8U | std::to_integer<std::uint64_t>(bytes[at + i]);
  return value;
}

Error damaged_zip(const std::string& where, const std::string& what) {
  return input_error(where, cat(what, "; the zip file is cut short or damaged"));
}

/// The place of the directory in the file.
struct ZipCentral {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::uint64_t entries = 0;
};

/// Reads the 64-bit end record, which a locator right before `end` points at; returns nullopt if there is no locator.
std::optional<ZipCentral> find_central64(const ZipBytes& file, std::uint64_t end, const std::string& where) {
  if (end < kLocator64Bytes) return std::nullopt;
  std::array<std::byte, kLocator64Bytes> locator{};
  file.read(end - kLocator64Bytes, locator);
  if (little_endian(locator, 0, 4) != kLocator64Magic) return std::nullopt;
  const std::uint64_t at = little_endian(locator, 8, 8);
  if (at > end - kLocator64Bytes || end - kLocator64Bytes - at < kEnd64Bytes) {
    throw damaged_zip(where, cat("its end record is said to lie at ", at));
  }
  std::array<std::byte, kEnd64Bytes> record{};
  file.read(at, record);
  if (little_endian(record, 0, 4) != kEnd64Magic) throw damaged_zip(where, cat("has no end record at ", at));
  return ZipCentral{little_endian(record, 48, 8), little_endian(record, 40, 8), little_endian(record, 32, 8)};
}

ZipCentral find_central(const ZipBytes& file, const std::string& where) {
  if (file.size < kEndBytes) throw damaged_zip(where, cat("has ", file.size, " bytes and no directory of a zip file"));
  std::vector<std::byte> tail(static_cast<std::size_t>(std::min<std::uint64_t>(file.size, kEndBytes + kMostComment)));
  file.read(file.size - tail.size(), tail);
  for (std::size_t at = tail.size() - kEndBytes + 1; at-- > 0;) {
    if (little_endian(tail, at, 4) != kEndMagic) continue;
    if (at + kEndBytes + little_endian(tail, at + 20, 2) > tail.size()) continue;
    const std::uint64_t end = file.size - tail.size() + at;
    ZipCentral central{little_endian(tail, at + 16, 4), little_endian(tail, at + 12, 4),
                       little_endian(tail, at + 10, 2)};
    if (const auto wide = find_central64(file, end, where)) central = *wide;
    if (central.offset > end || central.bytes > end - central.offset) {
      throw damaged_zip(where, cat("its directory is said to have ", central.bytes, " bytes at ", central.offset,
                                   ", and ends at ", end));
    }
    return central;
  }
  throw damaged_zip(where, "has no directory of a zip file at its end");
}

/// Replaces the numbers of `entry` that are stored in the 64-bit extra field.
void read_extra64(std::span<const std::byte> extra, ZipEntry& entry, const std::string& where) {
  while (extra.size() >= 4) {
    const std::uint64_t id = little_endian(extra, 0, 2);
    const std::uint64_t bytes = little_endian(extra, 2, 2);
    if (bytes > extra.size() - 4) break;
    if (id == kExtra64) {
      std::span<const std::byte> numbers = extra.subspan(4, bytes);
      for (std::uint64_t* const number : {&entry.bytes, &entry.packed, &entry.header}) {
        if (*number != kSeeExtra) continue;
        if (numbers.size() < 8) throw damaged_zip(where, "an entry of its directory lacks a size");
        *number = little_endian(numbers, 0, 8);
        numbers = numbers.subspan(8);
      }
      return;
    }
    extra = extra.subspan(4 + bytes);
  }
}

}  // namespace

bool begins_as_zip(std::span<const std::byte> head) {
  constexpr std::array kEntry{std::byte{'P'}, std::byte{'K'}, std::byte{3}, std::byte{4}};
  constexpr std::array kEmpty{std::byte{'P'}, std::byte{'K'}, std::byte{5}, std::byte{6}};
  const auto begins = [&](const auto& magic) {
    return head.size() >= magic.size() && std::equal(magic.begin(), magic.end(), head.begin());
  };
  return begins(kEntry) || begins(kEmpty);
}

ZipEntries read_zip_directory(const ZipBytes& file, std::uint64_t memory, const std::string& where) {
  const ZipCentral central = find_central(file, where);
  // A 16-bit record may have a wrapped count of entries, so the directory's bytes bound the count too.
  const std::uint64_t most = central.bytes / kCentralBytes;
  const std::uint64_t needed = 2 * central.bytes + std::min(central.entries, most) * kZipEntryBytes;
  if (needed > memory) {
    throw usage_error(compose(where, ": its directory of ", central.entries, " entries takes ", format_bytes(needed),
                              ", more than a sixteenth of ", option("memory"), "; give at least ",
                              (16 * needed >> 20U) + 1, "MiB"));
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(central.bytes));
  if (!bytes.empty()) file.read(central.offset, bytes);
  ZipEntries entries;
  std::span<const std::byte> rest(bytes);
  while (rest.size() >= kCentralBytes && little_endian(rest, 0, 4) == kCentralMagic) {
    const std::size_t name_bytes = little_endian(rest, 28, 2);
    const std::size_t extra_bytes = little_endian(rest, 30, 2);
    const std::size_t comment_bytes = little_endian(rest, 32, 2);
    const std::size_t all = kCentralBytes + name_bytes + extra_bytes + comment_bytes;
    if (all > rest.size()) throw damaged_zip(where, cat("entry ", entries.size(), " of its directory is cut"));
    ZipEntry entry{little_endian(rest, 42, 4),
                   little_endian(rest, 20, 4),
                   little_endian(rest, 24, 4),
                   static_cast<std::uint32_t>(little_endian(rest, 16, 4)),
                   static_cast<std::uint16_t>(little_endian(rest, 10, 2)),
                   (little_endian(rest, 8, 2) & 1U) != 0};
    read_extra64(rest.subspan(kCentralBytes + name_bytes, extra_bytes), entry, where);
    std::string name(reinterpret_cast<const char*>(rest.data()) + kCentralBytes, name_bytes);
    if (!name.empty() && name.back() != '/') entries.insert_or_assign(std::move(name), entry);
    rest = rest.subspan(all);
  }
  if (!rest.empty()) {
    throw damaged_zip(where, cat(rest.size(), " of the ", central.bytes, " bytes of its directory are no entries"));
  }
  return entries;
}

std::uint64_t zip_entry_begin(const ZipBytes& file, std::string_view name, const ZipEntry& entry,
                              const std::string& where) {
  std::array<std::byte, kLocalBytes> header{};
  if (entry.header > file.size || file.size - entry.header < kLocalBytes) {
    throw damaged_zip(where, cat("is said to lie at ", entry.header, " of ", file.size, " bytes"));
  }
  file.read(entry.header, header);
  if (little_endian(header, 0, 4) != kLocalMagic) throw damaged_zip(where, cat("has no header at ", entry.header));
  const std::uint64_t name_bytes = little_endian(header, 26, 2);
  const std::uint64_t begin = entry.header + kLocalBytes + name_bytes + little_endian(header, 28, 2);
  if (begin > file.size || entry.packed > file.size - begin) {
    throw damaged_zip(where,
                      cat("has ", entry.packed, " bytes at ", begin, ", beyond the ", file.size, " of the file"));
  }
  std::string found(static_cast<std::size_t>(name_bytes), '\0');
  if (!found.empty()) file.read(entry.header + kLocalBytes, std::as_writable_bytes(std::span(found)));
  // A wrong header must be found here: an entry that is read in parts is not checked against its CRC-32.
  if (found != name) throw damaged_zip(where, cat("has the header of another entry at ", entry.header));
  return begin;
}

}  // namespace weir
