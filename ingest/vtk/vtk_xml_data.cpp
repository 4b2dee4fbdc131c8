#include "ingest/vtk/vtk_xml_data.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "ingest/streams/spool_file.h"
#include "ingest/streams/stream_inflater.h"
#include "ingest/vtk/encoded_bytes.h"
#include "ingest/vtk/text_values.h"

namespace weir {
namespace {

using Format = VtkXmlArray::Format;

constexpr std::size_t kCopyBytes = std::size_t{256} << 10U;
/// Share of the memory ceiling that the list of compressed blocks may take.
constexpr std::uint64_t kBlockListShare = 8;

/// Reads one of the sizes before the data, in the file's byte order.
std::uint64_t read_size(EncodedBytes& encoded, const VtkXmlHeader& header) {
  std::array<std::byte, 8> bytes{};
  const auto stored = std::span(bytes).first(header.word_bytes);
  encoded.read(stored);
  if (header.big_endian) std::reverse(stored.begin(), stored.end());
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof size);
  return size;
}

[[noreturn]] void wrong_size(const std::string& where, std::uint64_t found, std::uint64_t expected) {
  throw Error(ErrorKind::input, cat(where, ": holds ", found, " bytes, and its header asks for ", expected,
                                    "; one of the two is damaged"));
}

using ByteSink = StreamInflater::Sink;

void copy_values(EncodedBytes& encoded, std::uint64_t bytes, const ByteSink& sink) {
  std::vector<std::byte> buffer(std::min<std::uint64_t>(bytes, kCopyBytes));
  for (std::uint64_t done = 0; done < bytes;) {
    const auto part = std::span(buffer).first(std::min<std::uint64_t>(buffer.size(), bytes - done));
    encoded.read(part);
    sink(part);
    done += part.size();
  }
}

/// The compressed blocks: their number, their unpacked size, the unpacked size of the last block if it is smaller
/// (otherwise 0), and the compressed size of each.
struct BlockList {
  std::uint64_t block_bytes = 0;
  std::uint64_t last_bytes = 0;
  std::vector<std::uint64_t> packed_bytes;
};

BlockList read_block_list(EncodedBytes& encoded, const VtkXmlHeader& header, std::uint64_t bytes, std::uint64_t memory,
                          const std::string& where) {
  const std::uint64_t count = read_size(encoded, header);
  BlockList list;
  list.block_bytes = read_size(encoded, header);
  list.last_bytes = read_size(encoded, header);
  // All blocks but the last are full. The comparison avoids a product that could overflow.
  const std::uint64_t full = list.last_bytes == 0 ? count : count - 1;
  if (list.last_bytes == 0) list.last_bytes = list.block_bytes;
  if (count == 0 || list.block_bytes == 0 || list.last_bytes > list.block_bytes || full > bytes / list.block_bytes ||
      (count - 1) * list.block_bytes + list.last_bytes != bytes) {
    throw Error(ErrorKind::input, cat(where, ": ", count, " blocks of ", list.block_bytes, " bytes, the last of ",
                                      list.last_bytes, ", do not make the ", bytes, " that its header asks for"));
  }
  if (count > memory / kBlockListShare / sizeof(std::uint64_t)) {
    throw Error(ErrorKind::usage,
                compose(where, ": has a list of ", count, " compressed blocks; give ",
                        option("memory", (count * kBlockListShare * sizeof(std::uint64_t) >> 20U) + 1),
                        "MiB or write larger blocks"));
  }
  // The vector is not reserved, so that a false count in the file costs no memory.
  for (std::uint64_t i = 0; i < count; ++i) list.packed_bytes.push_back(read_size(encoded, header));
  return list;
}

void inflate_blocks(EncodedBytes& encoded, const BlockList& list, const ByteSink& sink, const std::string& where) {
  std::vector<std::byte> buffer(kCopyBytes);
  for (std::size_t b = 0; b < list.packed_bytes.size(); ++b) {
    const bool last = b + 1 == list.packed_bytes.size();
    const std::uint64_t expected = last ? list.last_bytes : list.block_bytes;
    const std::string block = cat(where, ": block ", b);
    std::uint64_t unpacked = 0;
    StreamInflater inflater(block);
    for (std::uint64_t done = 0; done < list.packed_bytes[b];) {
      const auto part = std::span(buffer).first(std::min<std::uint64_t>(buffer.size(), list.packed_bytes[b] - done));
      encoded.read(part);
      inflater.push(part, [&](std::span<const std::byte> bytes) {
        unpacked += bytes.size();
        if (unpacked > expected) wrong_size(block, unpacked, expected);
        sink(bytes);
      });
      done += part.size();
    }
    inflater.finish();
    if (unpacked != expected) wrong_size(block, unpacked, expected);
  }
}

// Runs before space is allocated, so that a few bytes cannot reserve a disk. No encoding expands a byte further than
// these limits: text needs one character and a separator for a value, and deflate reaches 1032 to 1 (zlib, "Technical
// Details").
void check_plausible(std::uint64_t available, const VtkXmlHeader& header, const VtkXmlArray& array, std::uint64_t bytes,
                     const std::string& where) {
  constexpr std::uint64_t kMaxInflation = 1032;
  std::uint64_t most = 1;
  if (array.format == Format::ascii) {
    most = scalar_bytes(array.type);
  } else if (header.zlib) {
    most = kMaxInflation;
  }
  if (bytes / most > available) {
    throw Error(ErrorKind::input, cat(where, ": ", available, " bytes of the file cannot hold the ", bytes,
                                      " that its header asks for; the file is cut or one of the two damaged"));
  }
}

struct StoredBytes {
  std::uint64_t begin = 0;  ///< in the file
  std::uint64_t end = 0;
  bool base64 = false;
};

StoredBytes stored_bytes(const InputFile& file, const VtkXmlHeader& header, const VtkXmlArray& array,
                         const std::string& where) {
  if (array.format != Format::appended) return {array.begin, array.end, array.format == Format::binary};
  StoredBytes stored{0, file.size(), header.appended_base64};
  if (__builtin_add_overflow(*header.appended, array.begin, &stored.begin) || stored.begin >= stored.end) {
    throw Error(ErrorKind::input, cat(where, ": its data are to begin at byte ", array.begin,
                                      " of the appended data, behind the file's end; the file is cut or damaged"));
  }
  return stored;
}

}  // namespace

PlainValues plain_vtk_values(std::unique_ptr<InputFile> file, const VtkXmlHeader& header, const VtkXmlArray& array,
                             std::uint64_t bytes, const SourceOptions& options, const std::string& where) {
  const auto [begin, end, base64] = stored_bytes(*file, header, array, where);
  check_plausible(end - begin, header, array, bytes, where);
  const auto files = make_posix_file_system();
  if (array.format == Format::ascii) {
    SpoolFile spool(*files, options, file->path(), bytes);
    FileText text(*file, begin, end);
    spool_text_values(text, bytes / scalar_bytes(array.type), array.type, true, spool, where);
    return {spool.finish(), 0, false};
  }

  EncodedBytes encoded(*file, begin, end, base64, where);
  if (header.zlib) {
    const BlockList list = read_block_list(encoded, header, bytes, options.memory, where);
    SpoolFile spool(*files, options, file->path(), bytes);
    inflate_blocks(
        encoded, list, [&](std::span<const std::byte> part) { spool.write(part); }, where);
    return {spool.finish(), 0, header.big_endian};
  }
  if (const std::uint64_t found = read_size(encoded, header); found != bytes) wrong_size(where, found, bytes);
  if (base64) {
    SpoolFile spool(*files, options, file->path(), bytes);
    copy_values(encoded, bytes, [&](std::span<const std::byte> part) { spool.write(part); });
    return {spool.finish(), 0, header.big_endian};
  }
  const std::uint64_t first = begin + header.word_bytes;
  if (first > end || bytes > end - first) {
    throw Error(ErrorKind::input, cat(where, ": its data end too early; the file is cut or damaged"));
  }
  return {std::move(file), first, header.big_endian};
}

void read_vtk_values(InputFile& file, const VtkXmlHeader& header, const VtkXmlArray& array, std::span<std::byte> values,
                     const std::string& where) {
  const auto [begin, end, base64] = stored_bytes(file, header, array, where);
  EncodedBytes encoded(file, begin, end, base64, where);
  std::size_t filled = 0;
  const auto fill = [&](std::span<const std::byte> part) {
    if (part.size() > values.size() - filled) wrong_size(where, filled + part.size(), values.size());
    std::copy(part.begin(), part.end(), values.begin() + static_cast<std::ptrdiff_t>(filled));
    filled += part.size();
  };
  if (header.zlib) {
    constexpr std::uint64_t kListBytes = std::uint64_t{1} << 20U;
    inflate_blocks(encoded, read_block_list(encoded, header, values.size(), kListBytes, where), fill, where);
  } else {
    if (const std::uint64_t found = read_size(encoded, header); found != values.size()) {
      wrong_size(where, found, values.size());
    }
    copy_values(encoded, values.size(), fill);
  }
}

}  // namespace weir
