#include "ingest/files/input_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/refused_open.h"
#include "format/process/page_size.h"

namespace weir {
namespace {

Error open_error(const std::string& path, const std::string& what) {
  return Error(ErrorKind::input, cat(path, ": ", what));
}

// Returns whether mincore tells the truth about this file. Since Linux 5.2 it does so only for the file's owner and
// users who may write it; for others every page seems cached.
bool may_see_residency(const std::string& path, const struct stat& status) {
  return status.st_uid == ::geteuid() || ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
}

std::uint64_t round_down(std::uint64_t value, std::uint64_t unit) { return value / unit * unit; }
std::uint64_t round_up(std::uint64_t value, std::uint64_t unit) { return round_down(value + unit - 1, unit); }

}  // namespace

InputFile::InputFile(const std::string& path, DirectIo mode, const std::string& shown) : path_(shown), mode_(mode) {
  // O_NONBLOCK: opening a pipe must not wait for its writer. Regular files ignore it.
  buffered_.reset(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!buffered_) throw refused_open(shown, "open for reading", errno);
  struct stat status {};
  if (::fstat(buffered_.get(), &status) != 0) throw io_error(shown, "look at it", errno);
  if (S_ISDIR(status.st_mode)) throw open_error(shown, "is a directory; name a file in it");
  if (!S_ISREG(status.st_mode)) throw open_error(shown, "is not a regular file; copy its content to one");
  if (status.st_size == 0) throw open_error(shown, "is empty (0 bytes); copy it again, or write it anew");
  size_ = static_cast<std::uint64_t>(status.st_size);
  state_ = state_of(path, status);

  if (mode != DirectIo::off) {
    direct_.reset(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_DIRECT));
    if (!direct_ && mode == DirectIo::on) throw_refused();
  }
  direct_works_ = static_cast<bool>(direct_);

  if (mode != DirectIo::on && may_see_residency(path, status)) {
    void* mapping = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, buffered_.get(), 0);
    if (mapping != MAP_FAILED) mapping_ = static_cast<std::byte*>(mapping);
  }
  // POSIX_FADV_RANDOM turns read-ahead off. Pages of a read-ahead would look as if they had been cached before, and
  // would stay.
  if (mapping_ != nullptr) ::posix_fadvise(buffered_.get(), 0, 0, POSIX_FADV_RANDOM);
}

InputFile::~InputFile() {
  if (mapping_ != nullptr) ::munmap(mapping_, size_);
}

void InputFile::look(std::uint64_t first, std::span<unsigned char> resident) const {
  const std::uint64_t begin = first * page_bytes();
  const std::uint64_t end = std::min(begin + resident.size() * page_bytes(), round_up_to_page(size_));
  if (::mincore(mapping_ + begin, end - begin, resident.data()) == 0) return;
  std::fill(resident.begin(), resident.end(), std::uint8_t{1});  // unknown pages count as someone else's, so they stay
}

bool InputFile::is_cached(std::uint64_t offset, std::uint64_t count) const {
  std::array<unsigned char, kPagesPerLook> resident;
  const std::uint64_t last = (offset + count - 1) / page_bytes();
  for (std::uint64_t page = offset / page_bytes(); page <= last; page += kPagesPerLook) {
    const std::span pages(resident.data(), std::min<std::uint64_t>(kPagesPerLook, last - page + 1));
    look(page, pages);
    if (!std::all_of(pages.begin(), pages.end(), [](unsigned char flags) { return (flags & 1U) != 0; })) return false;
  }
  return true;
}

bool InputFile::looks_cached() const {
  if (mode_ == DirectIo::on || mapping_ == nullptr) return false;
  constexpr std::uint64_t kSamples = 256;
  const std::uint64_t pages = (size_ + page_bytes() - 1) / page_bytes();
  for (std::uint64_t i = 0; i < std::min(kSamples, pages); ++i) {
    if (!is_cached(pages * i / std::min(kSamples, pages) * page_bytes(), 1)) return false;
  }
  return true;
}

ReadPath InputFile::path_for(std::uint64_t offset, std::uint64_t count) const {
  if (mode_ != DirectIo::on && mapping_ != nullptr && is_cached(offset, count)) return ReadPath::cache;
  return direct_works_ ? ReadPath::direct : ReadPath::through;
}

void InputFile::read_buffered(std::uint64_t offset, std::span<std::byte> into, ReadPath path) {
  if (path == ReadPath::cache || mapping_ == nullptr) return fill(offset, into);
  const std::uint64_t chunk = kPagesPerLook * page_bytes();
  while (!into.empty()) {
    const std::uint64_t next = std::min(round_down(offset, chunk) + chunk, offset + into.size());
    read_through(offset, into.first(next - offset));
    into = into.subspan(next - offset);
    offset = next;
  }
}

void InputFile::fill(std::uint64_t offset, std::span<std::byte> into) {
  const std::size_t got = read_some(buffered_.get(), offset, into);
  if (got < into.size()) throw_short(offset, into.size(), offset + got);
}

void InputFile::read_through(std::uint64_t offset, std::span<std::byte> into) {
  std::array<unsigned char, kPagesPerLook> resident;
  const std::uint64_t first = offset / page_bytes();
  const std::uint64_t pages = (offset + into.size() - 1) / page_bytes() - first + 1;
  look(first, {resident.data(), pages});
  fill(offset, into);
  for (std::uint64_t page = 0; page < pages;) {
    std::uint64_t end = page;
    while (end < pages && (resident[end] & 1U) == 0) ++end;
    if (end > page) {
      ::posix_fadvise(buffered_.get(), static_cast<off_t>((first + page) * page_bytes()),
                      static_cast<off_t>((end - page) * page_bytes()), POSIX_FADV_DONTNEED);
    }
    page = end + 1;
  }
}

std::span<const std::byte> InputFile::read_direct(std::uint64_t offset, std::uint64_t count,
                                                  std::span<std::byte> staging) {
  const std::uint64_t begin = round_down(offset, kDirectAlignment);
  const std::uint64_t end = round_up(offset + count, kDirectAlignment);
  if (direct_works_) {
    bool refused = false;
    const std::size_t got = read_some(direct_.get(), begin, staging.first(end - begin), &refused);
    if (!refused) {
      if (begin + got < offset + count) throw_short(offset, count, begin + got);
      return staging.subspan(offset - begin, count);
    }
    if (mode_ == DirectIo::on) throw_refused();
    direct_works_ = false;
  }
  read_buffered(offset, staging.first(count), ReadPath::through);
  return staging.first(count);
}

std::size_t InputFile::read_some(int descriptor, std::uint64_t offset, std::span<std::byte> into, bool* refused) {
  std::size_t done = 0;
  while (done < into.size()) {
    const ssize_t got = ::pread(descriptor, into.data() + done, into.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EINVAL && refused != nullptr) {
      *refused = true;
      return 0;
    }
    if (got < 0) throw io_error(path_, cat("read ", into.size() - done, " bytes at offset ", offset + done), errno);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
    bytes_read_.fetch_add(static_cast<std::uint64_t>(got), std::memory_order_relaxed);
    // A direct read that stops at an unaligned offset has reached the end of the file.
    if (refused != nullptr && done % kDirectAlignment != 0) break;
  }
  return done;
}

void InputFile::throw_refused() const {
  throw Error(ErrorKind::usage,
              compose(path_, ": its file system refuses direct I/O; use ", option("direct-io", "auto")));
}

void InputFile::throw_short(std::uint64_t offset, std::uint64_t count, std::uint64_t end) const {
  throw Error(ErrorKind::input,
              cat(path_, ": the file ended at offset ", end, " while reading ", count, " bytes at offset ", offset,
                  "; it had ", size_, " bytes when it was opened: it was cut while being read"));
}

}  // namespace weir
