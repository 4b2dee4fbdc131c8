#include "ingest/streams/spool_inflated.h"

#include <algorithm>
#include <span>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "ingest/plan/page_buffer.h"
#include "ingest/streams/spool_file.h"
#include "ingest/streams/stream_inflater.h"

namespace weir {
namespace {

// No deflate stream unpacks to more than this many times its bytes (zlib, "Technical Details").
constexpr std::uint64_t kMaxInflation = 1032;
constexpr std::size_t kPackedPiece = std::size_t{1} << 20U;

}  // namespace

std::unique_ptr<InputFile> spool_inflated(InputFile& file, const PackedRange& packed, const UnpackedRange& wanted,
                                          const SourceOptions& options) {
  // This check comes before space is reserved: a few bytes of a damaged header must not reserve a whole disk.
  if (wanted.end / kMaxInflation > packed.bytes) {
    throw Error(ErrorKind::input, cat(file.path(), ": ", packed.bytes, " compressed bytes cannot hold the ", wanted.end,
                                      " bytes its header asks for; one of the two is damaged"));
  }
  const auto files = make_posix_file_system();
  SpoolFile spool(*files, options, file.path(), wanted.bytes);
  std::uint64_t position = 0;
  const auto keep = [&](std::span<const std::byte> bytes) {
    spool.check_cancel();
    const std::uint64_t begin = position;
    position += bytes.size();
    if (position > wanted.end) {
      throw Error(ErrorKind::input, cat(file.path(), ": unpacks to more than the ", wanted.end,
                                        " bytes its header asks for; one of the two is damaged"));
    }
    const std::uint64_t from = std::clamp(wanted.offset, begin, position);
    const std::uint64_t to = std::clamp(wanted.offset + wanted.bytes, begin, position);
    if (to > from) spool.write(bytes.subspan(from - begin, to - from));
  };
  StreamInflater inflater(file.path());
  PageBuffer buffer(kPackedPiece + 2 * kDirectAlignment);
  for (std::uint64_t done = 0; done < packed.bytes;) {
    const std::uint64_t count = std::min<std::uint64_t>(kPackedPiece, packed.bytes - done);
    const std::uint64_t offset = packed.offset + done;
    const ReadPath path = file.path_for(offset, count);
    if (path == ReadPath::direct) {
      inflater.push(file.read_direct(offset, count, buffer.bytes()), keep);
    } else {
      const auto bytes = buffer.bytes().first(count);
      file.read_buffered(offset, bytes, path);
      inflater.push(bytes, keep);
    }
    done += count;
  }
  inflater.finish();
  if (position < wanted.end) {
    throw Error(ErrorKind::input, cat(file.path(), ": unpacks to ", position, " bytes, and its header asks for ",
                                      wanted.end, "; one of the two is damaged"));
  }
  return spool.finish();
}

}  // namespace weir
