#include "ingest/vtk/file_text.h"

#include <algorithm>
#include <span>

#include "ingest/plan/staging.h"

namespace weir {

FileText::FileText(InputFile& file, std::uint64_t begin, std::uint64_t end)
    : file_(file), position_(begin), end_(std::min(end, file.size())), buffer_(kPieceBytes + 2 * kDirectAlignment) {}

std::string_view FileText::next_piece() {
  if (position_ >= end_) return {};
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kPieceBytes, end_ - position_));
  const ReadPath path = file_.path_for(position_, count);
  std::span<const std::byte> bytes;
  if (path == ReadPath::direct) {
    bytes = file_.read_direct(position_, count, buffer_.bytes());
  } else {
    file_.read_buffered(position_, buffer_.bytes().first(count), path);
    bytes = buffer_.bytes().first(count);
  }
  position_ += count;
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace weir
