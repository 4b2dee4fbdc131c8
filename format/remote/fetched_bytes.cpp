#include "format/remote/fetched_bytes.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/process/page_size.h"

namespace weir {
namespace {

/// The most bytes asked of the reader at once; the reader may hold as many again.
constexpr std::uint64_t kBatchBytes = std::uint64_t{64} << 20U;

std::span<std::byte> address_space(std::uint64_t bytes) {
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) {
    throw Error(ErrorKind::io, cat("no address space for a file of ", bytes, " bytes: ", std::strerror(errno),
                                   "; copy the file to this machine"));
  }
  ::madvise(memory, bytes, MADV_NOHUGEPAGE);  // a few bytes here and there must not take 2 MiB each
  return {static_cast<std::byte*>(memory), bytes};
}

}  // namespace

FetchedBytes::FetchedBytes(std::uint64_t bytes, RangeReader reader)
    : bytes_(address_space(bytes)), reader_(std::move(reader)) {}

FetchedBytes::~FetchedBytes() { ::munmap(bytes_.data(), bytes_.size()); }

bool FetchedBytes::has(const ByteRange& range) const {
  if (range.bytes == 0) return true;
  auto after = there_.upper_bound(range.offset);
  return after != there_.begin() && std::prev(after)->second >= range.end();
}

void FetchedBytes::fetch(const std::vector<ByteRange>& ranges) {
  std::vector<ByteRange> missing;
  for (ByteRange range : ranges) {
    // Parts that are held at either end are not read again.
    if (const auto after = there_.upper_bound(range.offset); after != there_.begin()) {
      const std::uint64_t begin = std::clamp(std::prev(after)->second, range.offset, range.end());
      range = {begin, range.end() - begin};
    }
    if (const auto last = there_.lower_bound(range.end()); range.bytes > 0 && last != there_.begin()) {
      const auto& [begin, end] = *std::prev(last);
      if (end >= range.end()) range.bytes = std::max(begin, range.offset) - range.offset;
    }
    for (; range.bytes > kBatchBytes; range = {range.offset + kBatchBytes, range.bytes - kBatchBytes}) {
      missing.push_back({range.offset, kBatchBytes});
    }
    if (range.bytes > 0) missing.push_back(range);
  }
  for (std::span<const ByteRange> left(missing); !left.empty();) {
    std::vector<ByteRange> batch;
    std::vector<std::span<std::byte>> into;
    for (std::uint64_t bytes = 0; !left.empty() && (batch.empty() || bytes + left.front().bytes <= kBatchBytes);) {
      batch.push_back(left.front());
      into.push_back(bytes_.subspan(batch.back().offset, batch.back().bytes));
      bytes += batch.back().bytes;
      left = left.subspan(1);
    }
    reader_(batch, into);
    for (const ByteRange& range : batch) add(range);
  }
}

void FetchedBytes::put(std::uint64_t offset, std::span<const std::byte> bytes) {
  std::ranges::copy(bytes, bytes_.subspan(offset, bytes.size()).begin());
  add({offset, bytes.size()});
}

void FetchedBytes::add(const ByteRange& range) {
  if (range.bytes == 0) return;
  std::uint64_t begin = range.offset;
  std::uint64_t end = range.end();
  auto next = there_.upper_bound(begin);
  if (next != there_.begin() && std::prev(next)->second >= begin) --next;
  while (next != there_.end() && next->first <= end) {
    begin = std::min(begin, next->first);
    end = std::max(end, next->second);
    held_ -= next->second - next->first;
    next = there_.erase(next);
  }
  there_.emplace(begin, end);
  held_ += end - begin;
}

void FetchedBytes::forget_from(std::uint64_t offset) {
  if (offset >= bytes_.size()) return;
  const std::uint64_t whole = std::min(round_up_to_page(offset), std::uint64_t{bytes_.size()});
  std::ranges::fill(bytes_.subspan(offset, whole - offset), std::byte{0});
  if (whole < bytes_.size()) ::madvise(bytes_.data() + whole, bytes_.size() - whole, MADV_DONTNEED);
  for (auto next = there_.begin(); next != there_.end();) {
    auto& [begin, end] = *next;
    if (end <= offset) {
      ++next;
      continue;
    }
    held_ -= end - std::max(begin, offset);
    if (begin < offset) {
      end = offset;
      ++next;
    } else {
      next = there_.erase(next);
    }
  }
}

}  // namespace weir
