#include "tools/export/file_sink.h"

#include <algorithm>
#include <span>

namespace weir {

void FileSinkbuf::flush() {
  if (buffer_.empty()) return;
  const auto bytes = std::as_bytes(std::span(buffer_));
  file_.write_at(flushed_, bytes);
  digest_.update(piece_digest(bytes));
  flushed_ += bytes.size();
  buffer_.clear();
}

FileSinkbuf::int_type FileSinkbuf::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char one = traits_type::to_char_type(c);
  xsputn(&one, 1);
  return c;
}

std::streamsize FileSinkbuf::xsputn(const char* text, std::streamsize count) {
  for (std::streamsize done = 0; done < count;) {
    const std::streamsize part = std::min(count - done, static_cast<std::streamsize>(kBufferBytes - buffer_.size()));
    buffer_.insert(buffer_.end(), text + done, text + done + part);
    done += part;
    if (buffer_.size() == kBufferBytes) flush();
  }
  return count;
}

}  // namespace weir
