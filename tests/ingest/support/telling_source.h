// A source that overrides every function of VolumeSource with a distinct answer, to test classes that forward calls.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "ingest/source/cell_places.h"
#include "ingest/source/held_leaves.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Records the boxes that a TellingSource was asked for, and holds the objects whose addresses it returns.
struct Told {
  class Held final : public HeldLeaves {
   public:
    std::span<const float> leaf(const Box& /*inside*/, std::array<float, kLeafVoxels>& room) const override {
      return room;
    }
  };
  class Places final : public CellPlaces {
   public:
    Box cell(const Index3& /*voxel*/) const override { return {}; }
    Index3 origin_of(const Index3& voxel) const override { return voxel; }
    Box origin_domain() const override { return {}; }
    const MinMax* reach(const Index3& /*voxel*/) const override { return nullptr; }
  };

  Held held;
  Places places;
  char device = 0;
  std::vector<Box> asked;  ///< boxes of the calls, in order

  ResidentVolume* resident() { return reinterpret_cast<ResidentVolume*>(&device); }  // an address to compare, no more
};

/// A source of 16 x 8 x 8 voxels; each way of reading fills the values with its own number.
class TellingSource final : public VolumeSource {
 public:
  static constexpr float kRead = 1;
  static constexpr float kAlone = 2;
  static constexpr float kRepeated = 3;

  /// `told` must outlive the source.
  explicit TellingSource(Told& told) : told_(told) { info_.extent = {16, 8, 8}; }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {2, {4, 4, 4}, {}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override { return fill(box, values, kRead); }
  bool in_memory() const override { return true; }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override { return fill(box, values, kAlone); }
  ResidentVolume* resident() override { return told_.resident(); }
  const CellPlaces* places() const override { return &told_.places; }
  /// Returns the lower half of `box` along x.
  std::vector<Box> voxels_with_values(const Box& box) const override {
    told_.asked.push_back(box);
    return {{box.lo, {(box.lo.x + box.hi.x) / 2, box.hi.y, box.hi.z}}};
  }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    told_.asked.push_back(box);
    return {{box, {2, 2, 2}}};
  }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return fill(part.box, values, kRepeated);
  }
  const HeldLeaves* held(const Box& box) const override {
    told_.asked.push_back(box);
    return &told_.held;
  }
  std::uint64_t working_bytes() const override { return 17; }
  std::uint64_t bytes_read() const override { return 18; }

 private:
  ConversionLoss fill(const Box& box, std::span<float> values, float value) {
    told_.asked.push_back(box);
    std::fill(values.begin(), values.end(), value);
    return {static_cast<std::uint64_t>(value), 0, 0};
  }

  Told& told_;
  SourceInfo info_;
};

}  // namespace weir
