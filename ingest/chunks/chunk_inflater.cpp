#include "ingest/chunks/chunk_inflater.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr int kWindowBits = 15;
constexpr int kGzipFlag = 16;  // added to the window bits, so that inflateReset2 expects gzip's header and trailer

bool only_zeros(std::span<const Bytef> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](Bytef byte) { return byte == 0; });
}

}  // namespace

ChunkInflater::ChunkInflater() {
  if (inflateInit(&stream_) != Z_OK) throw Error(ErrorKind::io, "memory: get a zlib decoder: out of memory");
}

ChunkInflater::~ChunkInflater() { inflateEnd(&stream_); }

void ChunkInflater::inflate(std::span<const std::byte> stream, std::span<std::byte> bytes) {
  const std::size_t filled = inflate_some(stream, bytes, DeflateWrapping::zlib);
  if (filled == bytes.size()) return;
  throw Error(ErrorKind::input, cat("its deflate stream ends after ", filled, " of ", bytes.size(), " bytes"));
}

std::size_t ChunkInflater::inflate_some(std::span<const std::byte> stream, std::span<std::byte> bytes,
                                        DeflateWrapping wrapping) {
  inflateReset2(&stream_, wrapping == DeflateWrapping::gzip ? kWindowBits + kGzipFlag : kWindowBits);
  stream_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(stream.data()));  // zlib does not write there
  stream_.avail_in = static_cast<uInt>(stream.size());
  stream_.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream_.avail_out = static_cast<uInt>(bytes.size());
  inflate_one(bytes.size());
  // bgzip, pigz and cat write streams of several members (RFC 1952, 2.2). gzip and Python read them as one stream.
  while (wrapping == DeflateWrapping::gzip && !only_zeros({stream_.next_in, stream_.avail_in})) {
    inflateReset(&stream_);
    inflate_one(bytes.size());
  }
  return bytes.size() - stream_.avail_out;
}

void ChunkInflater::inflate_one(std::size_t size) {
  const int status = ::inflate(&stream_, Z_FINISH);
  if (status == Z_STREAM_END) return;
  const std::size_t filled = size - stream_.avail_out;
  if (status == Z_BUF_ERROR && stream_.avail_in == 0) {
    throw Error(ErrorKind::input, cat("its deflate stream ends after ", filled, " of ", size, " bytes"));
  }
  if (status == Z_BUF_ERROR) {
    throw Error(ErrorKind::input, cat("its deflate stream holds more than ", size, " bytes"));
  }
  if (status == Z_MEM_ERROR) throw Error(ErrorKind::io, "memory: get a zlib decoder: out of memory");
  throw Error(ErrorKind::input, cat("its deflate stream is damaged after ", filled, " of ", size, " bytes (",
                                    stream_.msg != nullptr ? stream_.msg : zError(status), ")"));
}

}  // namespace weir
