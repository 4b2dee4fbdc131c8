#include "ingest/hdf5/storage/chunked_source.h"

#include <utility>

#include "ingest/hdf5/file/hdf5_file.h"

namespace weir {
namespace {

class ChunkedSource final : public VolumeSource {
 public:
  ChunkedSource(Hdf5Handle dataset, ChunkedSlice slice, SourceInfo info, std::uint64_t memory)
      : dataset_(std::move(dataset)), info_(std::move(info)), reader_(std::move(slice), memory) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return reader_.access(); }
  std::uint64_t working_bytes() const override { return reader_.working_bytes() + kHdf5MetadataBytes; }
  std::uint64_t bytes_read() const override { return reader_.counts().bytes_read; }
  ConversionLoss read(const Box& box, std::span<float> values) override { return reader_.read(box, values); }

 private:
  Hdf5Handle dataset_;
  SourceInfo info_;
  ChunkReader reader_;
};

}  // namespace

std::unique_ptr<VolumeSource> make_chunked_source(Hdf5Handle dataset, ChunkedSlice slice, SourceInfo info,
                                                  std::uint64_t memory) {
  return std::make_unique<ChunkedSource>(std::move(dataset), std::move(slice), std::move(info), memory);
}

}  // namespace weir
