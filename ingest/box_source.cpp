#include "ingest/box_source.h"

#include <utility>

#include "format/error.h"
#include "format/text.h"
#include "ingest/extent.h"

namespace weir {
namespace {

class BoxSource final : public VolumeSource {
 public:
  BoxSource(std::unique_ptr<VolumeSource> source, const Box& region)
      : source_(std::move(source)), info_(source_->info()) {
    info_.extent = region.extent();
    info_.index_origin = region.lo;
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return source_->access(); }
  std::uint64_t bytes_read() const override { return source_->bytes_read(); }
  bool in_memory() const override { return source_->in_memory(); }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    check(box);
    return source_->read(box, values);
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    check(box);
    return source_->read_alone(box, values);
  }

 private:
  void check(const Box& box) const {
    if (!box.empty() && info_.domain().contains(box)) return;
    throw Error(ErrorKind::internal,
                cat(info_.path, ": read of box ", box_text(box), " outside the region ", box_text(info_.domain())));
  }

  std::unique_ptr<VolumeSource> source_;
  SourceInfo info_;
};

}  // namespace

std::unique_ptr<VolumeSource> crop_source(std::unique_ptr<VolumeSource> source, const Box& region) {
  const SourceInfo& info = source->info();
  if (region.empty()) {
    throw Error(ErrorKind::usage, cat(info.path, ": --roi ", box_text(region),
                                      " holds no voxel; each axis is "
                                      "FROM:TO with FROM below TO"));
  }
  if (!info.domain().contains(region)) {
    throw Error(ErrorKind::usage, cat(info.path, ": --roi ", box_text(region), " reaches outside the volume ",
                                      box_text(info.domain()), "; keep it within"));
  }
  return std::make_unique<BoxSource>(std::move(source), region);
}

}  // namespace weir
