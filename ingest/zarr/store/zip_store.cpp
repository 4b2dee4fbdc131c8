#include "ingest/zarr/store/zip_store.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/zarr/store/zip_directory.h"

namespace weir {
namespace {

constexpr std::uint64_t kDirectoryShare = 16;  // of --memory
constexpr std::size_t kInputBytes = 64 << 10U;

/// A zlib decoder that is closed on every way out of its scope.
class RawInflater {
 public:
  RawInflater() {
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK)
      throw Error(ErrorKind::io, "memory: get a zlib decoder: out of memory");
  }
  ~RawInflater() { inflateEnd(&stream); }
  RawInflater(const RawInflater&) = delete;
  RawInflater& operator=(const RawInflater&) = delete;

  z_stream stream{};
};

class ZipObject final : public ZarrObject {
 public:
  ZipObject(const ZipBytes& file, std::string_view name, const ZipEntry& entry, std::string where)
      : file_(file), entry_(entry), begin_(zip_entry_begin(file, name, entry, where)), where_(std::move(where)) {}

  std::uint64_t size() const override { return entry_.bytes; }

  void read(std::uint64_t offset, std::span<std::byte> into) override {
    const bool whole = offset == 0 && into.size() == entry_.bytes;
    if (entry_.method == kZipStored) {
      if (!into.empty()) file_.read(begin_ + offset, into);
    } else if (whole) {
      inflate_into(into);
    } else {
      throw input_error(where_,
                        "is a shard, and deflated in the zip file, so that no part of it can be read alone; store "
                        "it (zip -0)");
    }
    if (whole) check_crc(into);
  }

 private:
  void inflate_into(std::span<std::byte> into) const {
    RawInflater inflater;
    z_stream& stream = inflater.stream;
    std::vector<std::byte> input(std::min<std::uint64_t>(kInputBytes, entry_.packed));
    stream.next_out = reinterpret_cast<Bytef*>(into.data());
    std::size_t room = into.size();
    int status = Z_OK;
    for (std::uint64_t at = 0; status == Z_OK && at < entry_.packed;) {
      const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(input.size(), entry_.packed - at));
      file_.read(begin_ + at, std::span(input).first(piece));
      at += piece;
      stream.next_in = reinterpret_cast<Bytef*>(input.data());
      stream.avail_in = static_cast<uInt>(piece);
      do {
        const auto give = static_cast<uInt>(std::min<std::size_t>(room, std::numeric_limits<uInt>::max()));
        stream.avail_out = give;
        status = ::inflate(&stream, Z_NO_FLUSH);
        room -= give - stream.avail_out;
      } while (status == Z_OK && stream.avail_in > 0);
    }
    if (status == Z_STREAM_END && room == 0) return;
    throw input_error(where_, cat("its deflated ", entry_.packed, " bytes do not give the ", entry_.bytes,
                                  " that the zip file's directory says; the zip file is damaged"));
  }

  void check_crc(std::span<const std::byte> bytes) const {
    const auto crc = static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
    if (crc == entry_.crc) return;
    throw input_error(where_, cat("its CRC-32 is ", hex(crc, 8), ", and the zip file's directory says ",
                                  hex(entry_.crc, 8), "; the zip file is damaged"));
  }

  const ZipBytes& file_;
  const ZipEntry& entry_;
  std::uint64_t begin_;
  std::string where_;
};

class ZipStore final : public ZarrStore {
 public:
  ZipStore(const std::string& path, std::uint64_t memory)
      : file_(path, DirectIo::off),
        bytes_{file_.size(),
               [this](std::uint64_t offset, std::span<std::byte> into) {
                 file_.read_buffered(offset, into, file_.path_for(offset, into.size()));
               }},
        entries_(read_zip_directory(bytes_, memory / kDirectoryShare, path)) {
    for (const auto& [name, entry] : entries_) held_ += name.size() + kZipEntryBytes;
  }

  std::string shown(std::string_view key) const override {
    return key.empty() ? file_.path() : cat(file_.path(), ": ", key);
  }
  std::string file_of(const std::string&) const override { return file_.path(); }
  bool is_one_file() const override { return true; }
  std::uint64_t held_bytes() const override { return held_; }

  ZarrFound find(const std::string& key) override {
    const auto found = entries_.find(key);
    if (found != entries_.end()) return {ZarrObjectState{found->second.bytes, 0, 0}, {}};
    const auto below = entries_.lower_bound(key + '/');
    if (below == entries_.end() || !below->first.starts_with(key + '/')) return {};
    return {{}, "is a directory in the zip file and not a file; write the zip file again"};
  }

  std::unique_ptr<ZarrObject> open(const std::string& key) override {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return nullptr;
    const ZipEntry& entry = found->second;
    if (entry.encrypted) throw input_error(shown(key), "is encrypted in the zip file; write it without a password");
    if (entry.method != kZipStored && entry.method != kZipDeflated) {
      throw input_error(shown(key), cat("is packed in the zip file by method ", entry.method,
                                        ", and only stored and deflated entries are read; store it (zip -0)"));
    }
    if (entry.method == kZipStored && entry.bytes != entry.packed) {
      throw input_error(shown(key), cat("is stored, and has ", entry.packed, " bytes and ", entry.bytes,
                                        " unpacked; the zip file is damaged"));
    }
    return std::make_unique<ZipObject>(bytes_, key, entry, shown(key));
  }

  std::vector<std::string> groups_in(const std::string& key) override {
    const std::string prefix = key.empty() ? "" : key + '/';
    std::vector<std::string> names;
    for (auto entry = entries_.lower_bound(prefix); entry != entries_.end() && entry->first.starts_with(prefix);) {
      const std::size_t slash = entry->first.find('/', prefix.size());
      if (slash == std::string::npos) {
        ++entry;
        continue;
      }
      names.push_back(entry->first.substr(prefix.size(), slash - prefix.size()));
      entry = entries_.lower_bound(entry->first.substr(0, slash) + static_cast<char>('/' + 1));
    }
    return names;
  }

 private:
  InputFile file_;
  ZipBytes bytes_;
  ZipEntries entries_;
  std::uint64_t held_ = 0;
};

}  // namespace

std::unique_ptr<ZarrStore> make_zip_store(const std::string& path, std::uint64_t memory) {
  std::array<std::byte, 4> head{};
  InputFile file(path, DirectIo::off);
  const auto begin = std::span(head).first(std::min<std::uint64_t>(head.size(), file.size()));
  file.read_buffered(0, begin, ReadPath::through);
  if (!begins_as_zip(begin)) throw input_error(path, cat("does not begin with PK, as zip files do", kNotAsNamed));
  return std::make_unique<ZipStore>(path, memory);
}

}  // namespace weir
