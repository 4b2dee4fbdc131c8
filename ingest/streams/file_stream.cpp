#include "ingest/streams/file_stream.h"

#include <algorithm>
#include <span>

namespace weir {

FileStreambuf::int_type FileStreambuf::underflow() {
  begin_ += static_cast<std::uint64_t>(egptr() - eback());
  setg(buffer_.data(), buffer_.data(), buffer_.data());
  if (begin_ >= file_.size()) return traits_type::eof();
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, file_.size() - begin_));
  file_.read_buffered(begin_, std::as_writable_bytes(std::span(buffer_).first(count)), ReadPath::cache);
  setg(buffer_.data(), buffer_.data(), buffer_.data() + count);
  return traits_type::to_int_type(*gptr());
}

FileStreambuf::pos_type FileStreambuf::seekoff(off_type offset, std::ios_base::seekdir from,
                                               std::ios_base::openmode which) {
  off_type base = 0;
  if (from == std::ios_base::cur) base = static_cast<off_type>(begin_) + (gptr() - eback());
  if (from == std::ios_base::end) base = static_cast<off_type>(file_.size());
  return seekpos(base + offset, which);
}

FileStreambuf::pos_type FileStreambuf::seekpos(pos_type position, std::ios_base::openmode) {
  const auto target = static_cast<off_type>(position);
  if (target < 0) return {off_type{-1}};
  const off_type inside = target - static_cast<off_type>(begin_);
  if (inside >= 0 && inside <= egptr() - eback()) {
    setg(eback(), eback() + inside, egptr());
  } else {
    begin_ = static_cast<std::uint64_t>(target);
    setg(buffer_.data(), buffer_.data(), buffer_.data());
  }
  return position;
}

}  // namespace weir
