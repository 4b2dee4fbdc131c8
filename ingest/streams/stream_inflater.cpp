#include "ingest/streams/stream_inflater.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::byte kGzipMagic{0x1F};
constexpr int kGzipOrZlib = 32 + MAX_WBITS;  ///< zlib.h, inflateInit2: detects the wrapper from its first bytes

}  // namespace

StreamInflater::StreamInflater(std::string where)
    : where_(std::move(where)), stream_(std::make_unique<z_stream_s>()), output_(kOutputBytes) {
  if (inflateInit2(stream_.get(), kGzipOrZlib) != Z_OK) throw std::bad_alloc();
}

StreamInflater::~StreamInflater() { inflateEnd(stream_.get()); }

void StreamInflater::push(std::span<const std::byte> packed, const Sink& sink) {
  if (packed_ == 0 && !packed.empty()) gzip_ = packed.front() == kGzipMagic;
  while (!packed.empty()) {
    if (ended_ && !restart(packed)) return;
    const auto piece = static_cast<uInt>(std::min<std::size_t>(packed.size(), std::numeric_limits<uInt>::max()));
    // zlib only reads next_in. Its type is not const without ZLIB_CONST, which cannot be defined early enough in a
    // grouped build.
    stream_->next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
    stream_->avail_in = piece;
    // If the output is full, zlib keeps the rest and returns it with the next call, even without new input.
    do {
      stream_->next_out = reinterpret_cast<Bytef*>(output_.data());
      stream_->avail_out = static_cast<uInt>(output_.size());
      const int status = inflate(stream_.get(), Z_NO_FLUSH);
      const std::size_t done = output_.size() - stream_->avail_out;
      unpacked_ += done;
      if (status == Z_DATA_ERROR || status == Z_NEED_DICT || status == Z_STREAM_ERROR) {
        packed_ += piece - stream_->avail_in;
        damaged(cat("damaged compressed data (", stream_->msg != nullptr ? stream_->msg : "needs a dictionary", ')'));
      }
      if (status == Z_MEM_ERROR) throw std::bad_alloc();
      if (done > 0) sink(std::span<const std::byte>(output_).first(done));
      ended_ = status == Z_STREAM_END;
    } while (!ended_ && (stream_->avail_in > 0 || stream_->avail_out == 0));
    const std::size_t taken = piece - stream_->avail_in;
    packed_ += taken;
    packed = packed.subspan(taken);
  }
}

// Continues after a member's end: skips zero padding and begins the next member. Returns false if only padding is
// left.
bool StreamInflater::restart(std::span<const std::byte>& packed) {
  const auto next = std::find_if(packed.begin(), packed.end(), [](std::byte b) { return b != std::byte{0}; });
  const auto padding = static_cast<std::size_t>(next - packed.begin());
  if (gzip_) {
    packed_ += padding;
    packed = packed.subspan(padding);
    if (packed.empty()) return false;
  }
  if (!gzip_ || packed.front() != kGzipMagic) damaged("bytes that belong to nothing after the compressed data");
  inflateReset(stream_.get());
  ended_ = false;
  return true;
}

void StreamInflater::finish() const {
  if (!ended_) damaged("the compressed data end too early, the file is cut");
}

void StreamInflater::damaged(const std::string& what) const {
  throw Error(ErrorKind::input, cat(where_, ": ", what, ", at byte ", packed_, " of them, ", unpacked_,
                                    " unpacked; copy the file again"));
}

}  // namespace weir
