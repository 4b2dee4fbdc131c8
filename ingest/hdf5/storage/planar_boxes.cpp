#include "ingest/hdf5/storage/planar_boxes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace weir {
namespace {

class PlanarBoxes final : public StoredBoxes {
 public:
  PlanarBoxes(std::vector<std::unique_ptr<StoredBoxes>> parts, std::size_t value_bytes)
      : parts_(std::move(parts)), value_bytes_(value_bytes) {}

  Index3 chunk() const override { return parts_[0]->chunk(); }
  Index3 chunk_origin() const override { return parts_[0]->chunk_origin(); }
  std::vector<std::string> files() const override {
    std::vector<std::string> all;
    for (const auto& part : parts_) {
      for (std::string& file : part->files()) all.push_back(std::move(file));
    }
    return all;
  }
  // The parts work one at a time, so only the largest counts. The buffer is added: it holds one number for each voxel
  // of a box, so it is smaller than the box's own values.
  std::uint64_t working_bytes() const override {
    std::uint64_t most = 0;
    for (const auto& part : parts_) most = std::max(most, part->working_bytes());
    const auto chunk_bytes = static_cast<std::uint64_t>(volume(max(chunk(), {1, 1, 1}))) * value_bytes_;
    return most + std::max(chunk_bytes, kAmpleBuffer);
  }

  void read(const Box& box, std::span<std::byte> stored) override {
    const auto voxels = static_cast<std::size_t>(box.voxels());
    buffer_.resize(voxels * value_bytes_);
    for (std::size_t c = 0; c < parts_.size(); ++c) {
      parts_[c]->read(box, buffer_);
      for (std::size_t i = 0; i < voxels; ++i) {
        std::memcpy(&stored[(i * parts_.size() + c) * value_bytes_], &buffer_[i * value_bytes_], value_bytes_);
      }
    }
  }

 private:
  std::vector<std::unique_ptr<StoredBoxes>> parts_;
  std::size_t value_bytes_;
  std::vector<std::byte> buffer_;
};

}  // namespace

std::unique_ptr<StoredBoxes> make_planar_boxes(std::vector<std::unique_ptr<StoredBoxes>> parts,
                                               std::size_t value_bytes) {
  return std::make_unique<PlanarBoxes>(std::move(parts), value_bytes);
}

}  // namespace weir
