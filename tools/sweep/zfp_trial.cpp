#include "tools/sweep/zfp_trial.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "compressor/leaf/exact_sum.h"
#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/process/process_memory.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/plan/staging.h"
#include "tools/sweep/zfp_codec.h"

namespace weir {
namespace {

/// Voxels that one worker codes at a time.
constexpr std::int64_t kPieceVoxels = std::int64_t{1} << 18U;
/// Memory for a worker's stack and the allocator's waste, and for library heaps and code pages touched later.
constexpr std::uint64_t kWorkerBytes = std::uint64_t{1} << 20U;
constexpr std::uint64_t kSlackBytes = std::uint64_t{16} << 20U;
constexpr std::uint64_t kLeastBlockTrialBytes = std::uint64_t{1} << 20U;
/// Larger blocks are not faster.
constexpr std::uint64_t kMostBlockTrialBytes = std::uint64_t{64} << 20U;

inline bool is_finite_value(float v) { return v - v == 0.0F; }

// The cut into blocks is shifted with the domain, because ZFP's blocks begin at the domain's corner.
AccessShape access_from_corner(const VolumeSource& source) {
  AccessShape access = source.access();
  access.chunk_origin = access.chunk_origin - source.info().index_origin;
  return access;
}

// Cuts `block` into pieces of whole ZFP blocks, at most kPieceVoxels voxels each, as long as possible in x, then y,
// then z.
std::vector<Box> pieces_of(const Box& block) {
  constexpr std::int64_t kFace = kZfpBlockDim * kZfpBlockDim;
  const auto up = [](std::int64_t n) { return (n + kZfpBlockDim - 1) / kZfpBlockDim * kZfpBlockDim; };
  const auto fit = [](std::int64_t n, std::int64_t most) {
    return std::clamp(most / kZfpBlockDim * kZfpBlockDim, kZfpBlockDim, n);
  };
  const Index3 extent{up(block.extent().x), up(block.extent().y), up(block.extent().z)};
  Index3 step;
  step.x = fit(extent.x, kPieceVoxels / kFace);
  step.y = fit(extent.y, kPieceVoxels / kZfpBlockDim / step.x);
  step.z = fit(extent.z, kPieceVoxels / step.x / step.y);
  std::vector<Box> pieces;
  for (std::int64_t z = block.lo.z; z < block.hi.z; z += step.z) {
    for (std::int64_t y = block.lo.y; y < block.hi.y; y += step.y) {
      for (std::int64_t x = block.lo.x; x < block.hi.x; x += step.x) {
        const Index3 lo{x, y, z};
        pieces.push_back(intersect({lo, lo + step}, block));
      }
    }
  }
  return pieces;
}

ZfpField field_of(const Block& block, const Box& piece) {
  const Index3 array = block.voxels.extent();
  return {&block.values[static_cast<std::size_t>(linear_index(piece.lo - block.voxels.lo, array))], piece.extent(),
          array};
}

// Calls visit(row of the field, index of its first voxel in the box).
template <typename Visit>
void for_each_row(const ZfpField& field, const Visit& visit) {
  for (std::int64_t z = 0; z < field.extent.z; ++z) {
    for (std::int64_t y = 0; y < field.extent.y; ++y) {
      visit(std::span(field.values + field.array.x * (y + field.array.y * z), static_cast<std::size_t>(field.extent.x)),
            static_cast<std::size_t>(field.extent.x * (y + field.extent.y * z)));
    }
  }
}

std::uint64_t count_nonfinite(const ZfpField& field) {
  std::uint64_t count = 0;
  for_each_row(field, [&](std::span<const float> row, std::size_t) {
    count +=
        static_cast<std::uint64_t>(std::count_if(row.begin(), row.end(), [](float v) { return !is_finite_value(v); }));
  });
  return count;
}

/// The error sums of one thread; the order of merging does not matter.
struct Tally {
  ExactSum squared_error;
  double max_abs = 0;
  std::uint64_t different = 0;
  std::uint64_t nonfinite_decoded = 0;
  float min = std::numeric_limits<float>::infinity();
  float max = -std::numeric_limits<float>::infinity();

  void add(float source, float decoded) {
    min = std::min(min, source);
    max = std::max(max, source);
    if (std::bit_cast<std::uint32_t>(source) == std::bit_cast<std::uint32_t>(decoded)) return;
    ++different;
    if (!is_finite_value(decoded)) {
      ++nonfinite_decoded;
      return;
    }
    const double difference = static_cast<double>(source) - static_cast<double>(decoded);
    squared_error.add(difference * difference);
    max_abs = std::max(max_abs, std::abs(difference));
  }

  void merge(const Tally& other) {
    squared_error.add(other.squared_error);
    max_abs = std::max(max_abs, other.max_abs);
    different += other.different;
    nonfinite_decoded += other.nonfinite_decoded;
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

class Trial {
 public:
  Trial(VolumeSource& source, const ZfpTrialOptions& options, const ConversionControl& control, File& stream)
      : options_(options), source_(source), control_(control), stream_(stream) {
    const SourceInfo& info = source.info();
    const BlockPlan plan = plan_blocks({{0, 0, 0}, info.extent}, access_from_corner(source), block_bytes());
    for (std::int64_t i = 0; i < plan.size(); ++i) {
      const Box box = plan.voxel_box(plan.leaf_box(i));
      boxes_.push_back({box.lo + info.index_origin, box.hi + info.index_origin});
    }
  }

  /// Writes the stream of every piece. Returns the number of voxels that are not finite.
  std::uint64_t compress() {
    tbb::enumerable_thread_specific<std::uint64_t> nonfinite(0);
    run("compress", [&](ZfpCodec& codec, const ZfpField& field, std::uint64_t offset) {
      const std::uint64_t count = count_nonfinite(field);
      nonfinite.local() += count;
      if (count == 0) stream_.write_at(offset, codec.compress(field));
    });
    stream_.sync();
    return nonfinite.combine(std::plus<>());
  }

  /// Compares source and stream. Sets `loss` to the loss of reading the source.
  Tally compare(ConversionLoss& loss) {
    tbb::enumerable_thread_specific<Tally> tallies;
    loss = run("compare", [&](ZfpCodec& codec, const ZfpField& field, std::uint64_t offset) {
      stream_.read_at(offset, codec.stream_buffer(field.extent));
      const std::span<const float> decoded = codec.decompress(field.extent);
      Tally& tally = tallies.local();
      for_each_row(field, [&](std::span<const float> row, std::size_t first) {
        for (std::size_t i = 0; i < row.size(); ++i) tally.add(row[i], decoded[first + i]);
      });
    });
    Tally total;
    for (const Tally& tally : tallies) total.merge(tally);
    return total;
  }

 private:
  // Returns the bytes of a block. The memory that --memory leaves holds two blocks at a time, and one piece with its
  // stream per worker.
  std::uint64_t block_bytes() const {
    const std::size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const std::uint64_t worker = static_cast<std::uint64_t>(kPieceVoxels) * sizeof(float) +
                                 zfp_stream_bytes({kPieceVoxels / 16, 4, 4}, options_.block_bits) + kWorkerBytes;
    const std::uint64_t fixed =
        resident_bytes() + source_.working_bytes() + kStagingBytes + kSlackBytes + threads * worker;
    if (options_.memory < fixed + 2 * kLeastBlockTrialBytes) {
      throw Error(ErrorKind::usage, cat("--memory ", format_bytes(options_.memory), " is too small for ZFP with ",
                                        threads, threads == 1 ? " thread" : " threads", "; give at least ",
                                        ((fixed + 2 * kLeastBlockTrialBytes) >> 20U) + 1, "MiB"));
    }
    return std::min((options_.memory - fixed) / 2, kMostBlockTrialBytes);
  }

  // Calls work(codec, piece's voxels, offset of its stream) for all pieces, and returns the loss of reading them. The
  // pieces of a block run in parallel. Their streams lie one after the other, each a whole number of words.
  template <typename Work>
  ConversionLoss run(const std::string& pass, const Work& work) {
    const auto voxels = static_cast<std::uint64_t>(volume(source_.info().extent));
    if (control_.pass_started) control_.pass_started(pass, voxels * sizeof(float));
    StreamOptions stream;
    stream.cancel = control_.cancel;
    stream.progress = [this](std::int64_t done, std::int64_t) {
      if (control_.pass_advanced) control_.pass_advanced(static_cast<std::uint64_t>(done) * sizeof(float));
    };
    tbb::enumerable_thread_specific<ZfpCodec> codecs(options_.block_bits);
    std::uint64_t offset = 0;
    return stream_blocks(source_, boxes_, stream, [&](const Block& block) {
      const std::vector<Box> pieces = pieces_of(block.voxels);
      std::vector<std::uint64_t> offsets;
      for (const Box& piece : pieces) {
        offsets.push_back(offset);
        offset += zfp_stream_bytes(piece.extent(), options_.block_bits);
      }
      tbb::parallel_for(std::size_t{0}, pieces.size(),
                        [&](std::size_t i) { work(codecs.local(), field_of(block, pieces[i]), offsets[i]); });
    });
  }

  const ZfpTrialOptions& options_;
  VolumeSource& source_;
  const ConversionControl& control_;
  File& stream_;
  std::vector<Box> boxes_;
};

}  // namespace

ZfpTrial try_zfp(VolumeSource& source, const ZfpTrialOptions& options, const ConversionControl& control,
                 FileSystem& files) {
  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<File> stream = files.create_unnamed(options.directory);
  Trial trial(source, options, control, *stream);
  ZfpTrial result;
  const Index3 extent = source.info().extent;
  result.bytes = zfp_stream_bytes(extent, options.block_bits);
  result.nonfinite = trial.compress();
  result.seconds = seconds_since(start);
  if (result.nonfinite > 0) return result;
  const Tally total = trial.compare(result.loss);
  result.nonfinite_decoded = total.nonfinite_decoded;
  const auto finite = static_cast<std::uint64_t>(volume(extent)) - total.nonfinite_decoded;
  result.error =
      make_certificate(total.squared_error.value(), total.max_abs, total.different == 0, finite, total.min, total.max);
  return result;
}

}  // namespace weir
