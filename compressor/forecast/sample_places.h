// The places of a sample's voxels in the volume that the sample was taken from.
#pragma once

#include "compressor/forecast/sample_plan.h"
#include "compressor/forecast/sample_reaches.h"
#include "ingest/source/cell_places.h"

namespace weir {

class SamplePlaces final : public CellPlaces {
 public:
  /// Makes the places of the sample of `plan` from a volume over `domain`.
  SamplePlaces(const SamplePlan& plan, const Box& domain)
      : plan_(plan), first_(plan.domain().lo), cell_(plan.cell()), domain_(domain) {}
  /// Makes the places of `part`, a part of the sample with the places `places`.
  SamplePlaces(const SamplePlan& part, const CellPlaces& places) : SamplePlaces(part, places.origin_domain()) {
    sample_ = &places;
  }

  /// Sets what reach() returns. `reaches` must outlive the object.
  void set_reaches(const SampleReaches* reaches) { reaches_ = reaches; }

  Box cell(const Index3& voxel) const override { return plan_.box(place_of(voxel)); }
  Index3 origin_of(const Index3& voxel) const override {
    const Index3 place = place_of(voxel);
    return plan_.source_corner(place) + (voxel - plan_.box(place).lo);
  }
  Box origin_domain() const override { return domain_; }
  const MinMax* reach(const Index3& voxel) const override {
    if (reaches_ != nullptr) return &reaches_->at(voxel);
    if (sample_ == nullptr) return nullptr;
    const Index3 place = place_of(voxel);
    return sample_->reach(plan_.sample_corner(place) + (voxel - plan_.box(place).lo));
  }

 private:
  Index3 place_of(const Index3& voxel) const {
    const Index3 in = voxel - first_;
    return {in.x / cell_.x, in.y / cell_.y, in.z / cell_.z};
  }

  SamplePlan plan_;
  Index3 first_;
  Index3 cell_;
  Box domain_;
  const CellPlaces* sample_ = nullptr;
  const SampleReaches* reaches_ = nullptr;
};

}  // namespace weir
