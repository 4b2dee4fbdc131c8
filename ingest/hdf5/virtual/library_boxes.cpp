#include "ingest/hdf5/virtual/library_boxes.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

// A chunk before and behind a filter: the library keeps both while it runs it.
constexpr std::uint64_t kChunkCopies = 2;

class LibraryBoxes final : public StoredBoxes {
 public:
  LibraryBoxes(Hdf5Handle dataset, const Storage& storage, std::vector<std::int64_t> index, std::string where)
      : dataset_(std::move(dataset)), index_(std::move(index)), where_(std::move(where)) {
    const Hdf5Lock lock;
    type_ = Hdf5Handle(H5Dget_type(dataset_.get()));
    space_ = Hdf5Handle(H5Dget_space(dataset_.get()));
    if (storage.chunk.size() < kVolumeRank) return;
    const auto at = [&](std::size_t from_end) {
      return static_cast<std::int64_t>(storage.chunk[storage.chunk.size() - from_end]);
    };
    chunk_ = {at(1), at(2), at(3)};
    library_bytes_ = kChunkCopies * H5Tget_size(type_.get());
    for (const hsize_t elements : storage.chunk) library_bytes_ *= elements;  // the library checks: below 2^32
  }

  Index3 chunk() const override { return chunk_; }
  std::uint64_t working_bytes() const override { return library_bytes_ + kHdf5MetadataBytes; }

  void read(const Box& box, std::span<std::byte> stored) override {
    const Hdf5Lock lock;
    const Hdf5Handle in_file = select_box(space_.get(), index_, box);
    const auto values = static_cast<hsize_t>(box.voxels());
    const Hdf5Handle in_memory(H5Screate_simple(1, &values, nullptr));
    // The file's own type in memory: conversion is ours.
    if (H5Dread(dataset_.get(), type_.get(), in_memory.get(), in_file.get(), H5P_DEFAULT, stored.data()) < 0) {
      throw hdf5_error(where_, cat("cannot be read at ", box_text(box), ", the file is cut short or damaged"));
    }
  }

 private:
  Hdf5Handle dataset_;
  std::vector<std::int64_t> index_;
  std::string where_;
  Hdf5Handle type_;
  Hdf5Handle space_;
  Index3 chunk_{0, 0, 0};
  std::uint64_t library_bytes_ = 0;
};

}  // namespace

Hdf5Handle select_box(hid_t space, const std::vector<std::int64_t>& index, const Box& box) {
  std::vector<hsize_t> start(index.begin(), index.end());
  std::vector<hsize_t> count(index.size(), 1);
  const Index3 e = box.extent();
  for (const std::int64_t lo : {box.lo.z, box.lo.y, box.lo.x}) start.push_back(static_cast<hsize_t>(lo));
  for (const std::int64_t n : {e.z, e.y, e.x}) count.push_back(static_cast<hsize_t>(n));
  Hdf5Handle selected(H5Scopy(space));
  H5Sselect_hyperslab(selected.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return selected;
}

std::unique_ptr<StoredBoxes> make_library_boxes(Hdf5Handle dataset, const Storage& storage,
                                                std::vector<std::int64_t> index, const std::string& where) {
  return std::make_unique<LibraryBoxes>(std::move(dataset), storage, std::move(index), where);
}

}  // namespace weir
