#include "tools/export/dense_input.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "compressor/refused_values.h"
#include "compressor/survey/background.h"
#include "compressor/survey/survey.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/io/temporary_directory.h"
#include "format/process/process_memory.h"
#include "ingest/plan/staging.h"

namespace weir {
namespace {

/// Memory for macrocells, pictures, stacks and libraries.
constexpr std::uint64_t kDenseBytes = std::uint64_t{128} << 20U;
/// Bytes of values read in one call, small enough that an interrupt does not wait for the whole volume.
constexpr std::int64_t kReadBytes = std::int64_t{64} << 20U;

void check_memory(const VolumeSource& source, std::optional<std::uint64_t> ceiling) {
  const SourceInfo& info = source.info();
  const std::uint64_t values = static_cast<std::uint64_t>(info.domain().voxels()) * sizeof(float);
  const std::uint64_t needed = values + source.working_bytes() + kStagingBytes + kDenseBytes;
  const std::uint64_t available = available_bytes();
  if (needed <= std::min(available, ceiling.value_or(available))) return;
  const std::string left = ceiling && *ceiling < available ? cat("--memory allows ", format_bytes(*ceiling))
                                                           : cat(format_bytes(available), " are available");
  throw Error(ErrorKind::usage, cat(info.path, ": --volume dense holds all ", info.extent.x, " x ", info.extent.y,
                                    " x ", info.extent.z, " voxels and needs ", format_bytes(needed), " of memory, ",
                                    left, "; show a part with --roi, or convert it and render the file"));
}

// Reads `source` in layers of z, which are contiguous in memory; in whole chunks if the source has chunks.
void read_layers(VolumeSource& source, const StreamOptions& options, float* values) {
  const Box domain = source.info().domain();
  const Index3 extent = domain.extent();
  const AccessShape access = source.access();
  const std::int64_t chunk = std::max<std::int64_t>(access.chunk.z, 1);
  const std::int64_t plane = extent.x * extent.y;
  const std::int64_t chunks = std::max<std::int64_t>(kReadBytes / 4 / plane / chunk, 1);
  for (std::int64_t z = domain.lo.z; z < domain.hi.z;) {
    const std::int64_t first_chunk = floor_div(z - access.chunk_origin.z, chunk);
    const std::int64_t end = std::min((first_chunk + chunks) * chunk + access.chunk_origin.z, domain.hi.z);
    const Box layers{{domain.lo.x, domain.lo.y, z}, {domain.hi.x, domain.hi.y, end}};
    source.read(layers, {values + (z - domain.lo.z) * plane, static_cast<std::size_t>((end - z) * plane)});
    if (options.cancel != nullptr && *options.cancel) {
      throw Error(ErrorKind::interrupted, "interrupted; no image was written");
    }
    z = end;
    if (options.progress) options.progress((z - domain.lo.z) * plane, domain.voxels());
  }
}

// The values in memory as a source, for the survey that finds the background.
class MemorySource final : public VolumeSource {
 public:
  MemorySource(SourceInfo info, const float* values) : info_(std::move(info)), values_(values) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {}; }
  bool in_memory() const override { return true; }
  std::uint64_t bytes_read() const override { return 0; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    const Index3 extent = info_.extent;
    const auto row = static_cast<std::size_t>(box.hi.x - box.lo.x);
    float* to = values.data();
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; ++y, to += row) {
        const Index3 at = Index3{box.lo.x, y, z} - info_.index_origin;
        std::memcpy(to, values_ + at.x + extent.x * (at.y + extent.y * at.z), row * sizeof(float));
      }
    }
    return {};
  }

 private:
  SourceInfo info_;
  const float* values_;
};

float find_background(const SourceInfo& info, const float* values, MissingPolicy missing) {
  constexpr std::uint64_t kBlockBytes = std::uint64_t{1} << 20U;
  MemorySource source(info, values);
  const BlockPlan plan = plan_blocks(info.domain(), source.access(), kBlockBytes);
  const auto files = make_posix_file_system();
  RowStore rows(files->create_unnamed(temporary_directory()), plan.lattice, {});
  const Survey survey = survey_volume(source, plan, rows, {}, {.reading = Reading::in_place});
  if (missing == MissingPolicy::error) refuse_missing(survey, info);
  return weir::find_background(survey, rows, source, plan, {}).value;
}

void fill_missing(float* values, std::int64_t count, float background) {
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::int64_t>(0, count, 1 << 16), [&](const auto& part) {
    for (std::int64_t i = part.begin(); i < part.end(); ++i) {
      if (is_missing(values[i])) values[i] = background;
    }
  });
}

}  // namespace

std::shared_ptr<const DenseVolume> read_dense(VolumeSource& source, const StreamOptions& options, MissingPolicy missing,
                                              std::optional<std::uint64_t> ceiling) {
  check_memory(source, ceiling);
  const SourceInfo& info = source.info();
  const std::int64_t count = info.domain().voxels();
  // Not initialised, so that pages are first touched when values are read into them.
  auto values = std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(count));
  read_layers(source, options, values.get());
  const float background = find_background(info, values.get(), missing);
  fill_missing(values.get(), count, background);
  return std::make_shared<const DenseVolume>(GridFrame{info.domain(), info.spacing, info.origin}, std::move(values),
                                             background);
}

}  // namespace weir
