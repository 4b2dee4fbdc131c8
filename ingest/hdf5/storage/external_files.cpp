#include "ingest/hdf5/storage/external_files.h"

#include <sys/types.h>

#include <algorithm>
#include <array>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/side_files.h"

namespace weir {
namespace {

constexpr const char* kExternalPrefix = "HDF5_EXTFILE_PREFIX";

class ExternalBoxes final : public StoredBoxes {
 public:
  ExternalBoxes(std::vector<ExternalPart> parts, const Index3& extent, std::size_t value_bytes,
                std::uint64_t first_byte, DirectIo mode)
      : parts_(std::move(parts)), extent_(extent), value_bytes_(value_bytes), first_byte_(first_byte), mode_(mode) {}

  Index3 chunk() const override { return {0, 0, 0}; }
  std::uint64_t working_bytes() const override { return 0; }

  void read(const Box& box, std::span<std::byte> stored) override {
    const std::size_t row = static_cast<std::size_t>(box.extent().x) * value_bytes_;
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
        const auto voxel = static_cast<std::uint64_t>(linear_index({box.lo.x, y, z}, extent_));
        read_at(first_byte_ + voxel * value_bytes_, stored.first(row));
        stored = stored.subspan(row);
      }
    }
  }

 private:
  // `at` is a byte offset in the dataset.
  void read_at(std::uint64_t at, std::span<std::byte> into) {
    std::uint64_t part_begin = 0;
    for (std::size_t i = 0; !into.empty(); part_begin += parts_[i++].bytes) {
      const std::uint64_t part_end = part_begin + parts_[i].bytes;
      if (at >= part_end) continue;
      const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(into.size(), part_end - at));
      InputFile& file = open_part(i);
      const std::uint64_t offset = parts_[i].offset + (at - part_begin);
      file.read_buffered(offset, into.first(bytes), file.path_for(offset, bytes));
      into = into.subspan(bytes);
      at += bytes;
    }
  }

  // Keeps one part open at a time, because there may be more parts than a process may open files.
  InputFile& open_part(std::size_t i) {
    if (!file_ || open_ != i) file_ = std::make_unique<InputFile>(parts_[i].path, mode_);
    open_ = i;
    return *file_;
  }

  std::vector<ExternalPart> parts_;
  Index3 extent_;
  std::size_t value_bytes_;
  std::uint64_t first_byte_;
  DirectIo mode_;
  std::unique_ptr<InputFile> file_;
  std::size_t open_ = 0;
};

}  // namespace

std::vector<ExternalPart> external_parts(hid_t creation, std::uint64_t bytes, const std::string& parent,
                                         const std::string& where) {
  std::vector<ExternalPart> parts;
  const int count = H5Pget_external_count(creation);
  for (int i = 0; i < count && bytes > 0; ++i) {
    std::array<char, 4097> name{};
    off_t offset = 0;
    hsize_t size = 0;
    if (H5Pget_external(creation, static_cast<unsigned>(i), name.size() - 1, name.data(), &offset, &size) < 0 ||
        offset < 0) {
      throw Error(ErrorKind::input, cat(where, ": the names of its external files cannot be read"));
    }
    const auto path = find_side_file(name.data(), parent, kExternalPrefix);
    if (!path) {
      throw Error(ErrorKind::input, cat(where, ": its values lie in the file ", name.data(),
                                        ", which is not there; put it beside ", parent, " or set ", kExternalPrefix));
    }
    ExternalPart part{*path, static_cast<std::uint64_t>(offset), std::min<std::uint64_t>(size, bytes)};
    const std::uint64_t held = InputFile(part.path, DirectIo::off).size();
    if (part.offset > held || part.bytes > held - part.offset) {
      throw Error(ErrorKind::input, cat(where, ": needs ", part.bytes, " bytes at ", part.offset, " of ", part.path,
                                        ", and that has ", held, "; it is cut short"));
    }
    bytes -= part.bytes;
    parts.push_back(std::move(part));
  }
  if (bytes > 0) throw Error(ErrorKind::input, cat(where, ": its external files hold ", bytes, " bytes too few"));
  return parts;
}

std::unique_ptr<StoredBoxes> make_external_boxes(std::vector<ExternalPart> parts, const Index3& extent,
                                                 std::size_t value_bytes, std::uint64_t first_byte, DirectIo mode) {
  return std::make_unique<ExternalBoxes>(std::move(parts), extent, value_bytes, first_byte, mode);
}

}  // namespace weir
