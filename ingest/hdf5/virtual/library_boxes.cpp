#include "ingest/hdf5/virtual/library_boxes.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

// The library keeps a chunk before and after a filter while the filter runs.
constexpr std::uint64_t kChunkCopies = 2;

class LibraryBoxes final : public StoredBoxes {
 public:
  LibraryBoxes(Hdf5Handle dataset, const Storage& storage, ArrayPlace place, std::string where)
      : dataset_(std::move(dataset)),
        place_(std::move(place)),
        where_(std::move(where)),
        crash_line_(hdf5_crash_line(where_)) {
    const Hdf5Lock lock;
    type_ = Hdf5Handle(H5Dget_type(dataset_.get()));
    space_ = Hdf5Handle(H5Dget_space(dataset_.get()));
    if (storage.kind == StorageKind::chunked) fill_ = storage.fill;
    if (storage.chunk.size() < place_.index.size() + place_.axes.size()) return;
    const auto at = [&](std::size_t i) { return static_cast<std::int64_t>(storage.chunk[place_.axes.at(i)]); };
    chunk_ = {at(2), at(1), at(0)};
    library_bytes_ = kChunkCopies * H5Tget_size(type_.get());
    for (const hsize_t elements : storage.chunk) library_bytes_ *= elements;  // the library checks: below 2^32
  }

  Index3 chunk() const override { return chunk_; }
  std::uint64_t working_bytes() const override { return library_bytes_ + kHdf5MetadataBytes; }

  void read(const Box& box, std::span<std::byte> stored) override {
    const Hdf5ReadLock lock(crash_line_);
    const Hdf5Handle in_file = select_box(space_.get(), place_, box);
    const auto values = static_cast<hsize_t>(H5Sget_select_npoints(in_file.get()));
    const Hdf5Handle in_memory(H5Screate_simple(1, &values, nullptr));
    if (!fill_.empty()) repeat_value(fill_, stored);
    // Reads with the file's own type as memory type, because weir converts the values itself.
    if (H5Dread(dataset_.get(), type_.get(), in_memory.get(), in_file.get(), H5P_DEFAULT, stored.data()) < 0) {
      throw hdf5_error(where_, cat("cannot be read at ", box_text(box), ", the file is cut short or damaged"));
    }
  }

 private:
  Hdf5Handle dataset_;
  ArrayPlace place_;
  std::string where_;
  std::string crash_line_;
  Hdf5Handle type_;
  Hdf5Handle space_;
  std::vector<std::byte> fill_;  ///< a stored value; of chunks, which the library may leave as they are in memory
  Index3 chunk_{0, 0, 0};
  std::uint64_t library_bytes_ = 0;
};

}  // namespace

ArrayPlace ArrayPlace::behind(std::vector<std::int64_t> index) {
  const std::size_t first = index.size();
  return {{first, first + 1, first + 2}, std::move(index)};
}

Hdf5Handle select_box(hid_t space, const ArrayPlace& place, const Box& box) {
  std::vector<hsize_t> start(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)), 0);
  std::vector<hsize_t> count(start.size());
  H5Sget_simple_extent_dims(space, count.data(), nullptr);  // what is said of no axis is selected whole
  const Index3 e = box.extent();
  const std::array<std::int64_t, 3> first{box.lo.z, box.lo.y, box.lo.x};
  const std::array<std::int64_t, 3> extent{e.z, e.y, e.x};
  std::size_t position = 0;
  std::size_t of_volume = 0;
  for (std::size_t axis = 0; axis < start.size(); ++axis) {
    if (of_volume < place.axes.size() && place.axes.at(of_volume) == axis) {
      start[axis] = static_cast<hsize_t>(first.at(of_volume));
      count[axis] = static_cast<hsize_t>(extent.at(of_volume++));
    } else if (position < place.index.size()) {
      start[axis] = static_cast<hsize_t>(place.index[position++]);
      count[axis] = 1;
    }
  }
  Hdf5Handle selected(H5Scopy(space));
  H5Sselect_hyperslab(selected.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return selected;
}

std::unique_ptr<StoredBoxes> make_library_boxes(Hdf5Handle dataset, const Storage& storage, ArrayPlace place,
                                                const std::string& where) {
  return std::make_unique<LibraryBoxes>(std::move(dataset), storage, std::move(place), where);
}

}  // namespace weir
