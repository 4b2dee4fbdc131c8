// Interfaces of a device that surveys and encodes many packed blocks at a time. Its results have the same bits as the
// host's; blocks that it leaves undone are done by its caller. Code that has a device makes these objects; the
// conversion knows only the interfaces: BlockCoder for values of the host, ResidentVolume for values that are on the
// device already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "format/base/host_device.h"
#include "format/base/index.h"
#include "format/io/digest.h"
#include "format/leaf/block_summary.h"
#include "format/leaf/leaf_record.h"
#include "format/packed/block_constants.h"
#include "format/packed/block_steps.h"
#include "format/packed/near_rungs.h"

namespace weir {

/// Chooses who surveys and encodes packed blocks. automatic: a CUDA device if one answers and has memory for it,
/// otherwise the CPU.
enum class CoderChoice : std::uint8_t { automatic, cpu, cuda };

/// Which near rungs of a ladder a survey computes. It also computes the stream of floats in their own order if it
/// computes all near rungs, or if most values of the block are zero.
struct NearAsk {
  NearBlocks blocks{};      ///< which blocks have near rungs
  bool all = true;          ///< all near rungs; otherwise only those around `wanted`
  std::int32_t wanted = 0;  ///< exponent of a quantum

  /// Returns the most near rungs that are computed for a block.
  WEIR_HOST_DEVICE std::uint32_t most() const {
    return blocks == NearBlocks::none ? 0U : all ? static_cast<std::uint32_t>(kNearRungs) : kAbout;
  }
  /// Returns the first near rung that is computed of a ladder with a coarsest quantum of the exponent `coarsest`.
  WEIR_HOST_DEVICE std::uint32_t first(std::int32_t coarsest) const {
    if (all) return 0;
    constexpr std::int32_t kCoarser = 2;
    constexpr std::int32_t kLast = kNearRungs - static_cast<std::int32_t>(kAbout);
    const std::int32_t rung = near_rung_about(coarsest, wanted) - kCoarser;
    return static_cast<std::uint32_t>(rung < 0 ? 0 : rung > kLast ? kLast : rung);
  }
  /// Near rungs computed around `wanted`. A search hardly ever goes more than two to either side.
  static constexpr std::uint32_t kAbout = 6;
};

/// The keys between which the cut lies. A key is the squared error that a byte saves. Rungs that no search for a cut in
/// this range needs can be left out.
struct SearchKeys {
  double low = 0;
  double high = 0;        ///< 0: all rungs are computed
  bool compares = false;  ///< whether rungs or near rungs far behind the others are left out

  WEIR_HOST_DEVICE bool known() const { return high > 0; }
};

/// Which rungs of a ladder a survey computes.
struct RungAsk {
  bool all = true;          ///< all from kLadderMeanRungs on; otherwise only those around `wanted`
  std::int32_t wanted = 0;  ///< step
  NearAsk near{};
  SearchKeys keys{};

  /// Returns the most rungs that are computed for a block.
  WEIR_HOST_DEVICE std::uint32_t most() const {
    return all ? static_cast<std::uint32_t>(kLadderRungs - kLadderMeanRungs) : kRungsAbout;
  }
  /// Returns the rung at which a search around `wanted` begins, for a ladder with the given first step.
  WEIR_HOST_DEVICE std::uint32_t start(std::int32_t first_step) const {
    return static_cast<std::uint32_t>(rung_about(first_step, wanted));
  }
  /// Returns whether the range of the cuts that are searched for is known.
  WEIR_HOST_DEVICE bool searches() const { return !all && keys.known(); }
  /// Returns the first rung that is asked for.
  WEIR_HOST_DEVICE std::uint32_t first(std::int32_t first_step) const {
    constexpr std::uint32_t kFirst = kLadderMeanRungs;
    if (all) return kFirst;
    constexpr std::uint32_t kCoarser = 4;
    constexpr std::uint32_t kLast = kLadderRungs - kRungsAbout;
    const std::uint32_t about = start(first_step);
    return about < kFirst + kCoarser ? kFirst : about - kCoarser > kLast ? kLast : about - kCoarser;
  }
  /// Rungs computed around `wanted`. A search goes four rungs to the coarse side and three to the fine side.
  static constexpr std::uint32_t kRungsAbout = 8;
};

/// The result of TransformBlock::cost() for a rung.
struct RungCost {
  double squared_error = 0;
  std::uint32_t bits = 0;  ///< 0: not computed
  std::uint32_t unused = 0;
};

/// The result of RoundedBlock::cost() for a near rung.
struct NearCost {
  double squared_error = 0;
  std::uint32_t bytes = 0;  ///< 0: not computed
  std::uint32_t unused = 0;
};
/// NearCost::bytes of a near rung that was computed but is not possible.
inline constexpr std::uint32_t kNoNearBytes = ~0U;

/// The results of TransformBlock::set() for a block.
struct BlockFigures {
  double energy = 0;
  float mean = 0;
  float largest = 0;
  std::int16_t first_step = 0;   ///< first step of the ladder
  std::uint8_t first_rung = 0;   ///< first of the rungs asked for
  std::uint8_t rungs = 0;        ///< number of rungs asked for
  std::uint8_t transformed = 0;  ///< 0: the values are too large or too small for a transform
  std::uint8_t lattice = 0;      ///< whether the values may lie on a lattice; a slower check decides
  std::uint8_t first_near = 0;   ///< first of the near rungs asked for
  std::uint8_t near = 0;         ///< number of near rungs asked for
  /// Bytes of the stream of floats in their own order, at most kRawStreamBytes; 0: not computed.
  std::uint16_t ordered_bytes = 0;
  std::uint16_t unused[3] = {};
};

/// The content of a stream.
enum class StreamAskKind : std::uint8_t {
  transform,  ///< coefficients, quantised at a step
  rounded,    ///< values rounded to multiples of 2^step
  exact       ///< every bit, in the given number of bytes, if the source's type does not say that values lie on a
              ///< lattice
};

/// A request to write a stream.
struct StreamAsk {
  MeanRange means;           ///< of the block's region
  std::uint32_t block = 0;   ///< index of the block in the box, x fastest
  std::uint32_t offset = 0;  ///< offset among all streams: at or behind the end of the previous ask
  std::uint16_t bytes = 0;
  std::int16_t step = 0;
  StreamAskKind kind{};
};

/// The results of a survey for one block.
struct SurveyedBlock {
  const BlockFigures& figures;
  std::span<const RungCost> costs;  ///< RungAsk::most() costs, from rung figures.first_rung on
  std::span<const NearCost> near;   ///< NearAsk::most() costs, from near rung figures.first_near on
};

/// The results of a survey for all blocks, one after the other.
struct SurveyedBlocks {
  std::span<const BlockFigures> figures;
  std::span<const RungCost> costs;
  std::span<const NearCost> near;
  /// For resident blocks only: the summary of each block that lies wholly in the volume and has only finite values. If
  /// it has others, only `finite` is set.
  std::span<const BlockSummary> summaries;

  SurveyedBlock block(std::size_t at) const {
    const std::size_t rungs = costs.size() / figures.size();
    const std::size_t near_rungs = near.size() / figures.size();
    return {figures[at], costs.subspan(rungs * at, rungs), near.subspan(near_rungs * at, near_rungs)};
  }
};

/// Streams and their decoded values, in the order of the asks.
struct MadeStreams {
  std::span<std::byte> bytes;  ///< all streams, at the offsets of the asks; the caller may use the bytes between, which
                               ///< hold anything
  std::span<const float> decoded;      ///< 512 values of each, in the order of a leaf; none for resident blocks
  std::span<const std::uint8_t> made;  ///< 0: the caller has to encode it
  // For resident blocks only.
  std::span<const LeafRecord> records;  ///< data for the nodes above the blocks
  std::span<const Digest> sources;      ///< digests of their blocks' values
};

/// Streams that are being written.
class PendingStreams {
 public:
  PendingStreams() = default;
  virtual ~PendingStreams() = default;
  PendingStreams(const PendingStreams&) = delete;
  PendingStreams& operator=(const PendingStreams&) = delete;

  /// Waits for the streams. The result stays valid as long as the object. Nullopt if encoding has failed.
  virtual std::optional<MadeStreams> wait() = 0;
};

/// The values of a box, loaded on the device for surveying and encoding. Only one thread uses it.
class LoadedBlocks {
 public:
  LoadedBlocks() = default;
  virtual ~LoadedBlocks() = default;
  LoadedBlocks(const LoadedBlocks&) = delete;
  LoadedBlocks& operator=(const LoadedBlocks&) = delete;

  /// Begins to survey all blocks of the box.
  virtual void begin_survey(const RungAsk& ask) = 0;
  /// Waits for the survey. The result stays valid as long as the object. Nullopt if the survey has failed.
  virtual std::optional<SurveyedBlocks> end_survey() = 0;

  /// Begins to write the streams of some blocks, at least one ask; the object must live until they are waited for. Null
  /// if that has failed.
  virtual std::unique_ptr<PendingStreams> encode(std::span<const StreamAsk> asks, const BlockConstants& constants) = 0;
};

/// Any thread may use it at any time. It reports a failure once and leaves everything after it to the caller.
class BlockCoder {
 public:
  BlockCoder() = default;
  virtual ~BlockCoder() = default;
  BlockCoder(const BlockCoder&) = delete;
  BlockCoder& operator=(const BlockCoder&) = delete;

  /// Loads values over `voxels`, x fastest. `blocks` is the box of all their blocks, with sides that are multiples of
  /// 8. If `blocks` is larger than `voxels`, values outside are those of the nearest voxel inside. Null if the coder
  /// has failed, has no room, or is busy: the caller then does the work.
  virtual std::unique_ptr<LoadedBlocks> load(std::span<const float> values, const Box& voxels, const Box& blocks) = 0;

  /// Returns the most bytes of the process's memory that it takes while it works.
  virtual std::uint64_t host_bytes() const = 0;
};

/// Blocks of a resident volume. Streams are encoded once, after the survey; encode() invalidates the result of
/// end_survey(). The streams stay valid as long as the blocks.
class ResidentBlocks : public LoadedBlocks {
 public:
  /// Returns the values of `blocks`, 512 of each in the order of a leaf; outside the volume they are those of the
  /// nearest voxel inside. They stay valid until the next call. Nullopt if that has failed.
  virtual std::optional<std::span<const float>> values(std::span<const std::uint32_t> blocks) = 0;
};

/// A volume of float32 values, x fastest and without gaps, that lies on the device: only results cross the host's
/// memory. Any thread may use it at any time.
class ResidentVolume {
 public:
  ResidentVolume() = default;
  virtual ~ResidentVolume() = default;
  ResidentVolume(const ResidentVolume&) = delete;
  ResidentVolume& operator=(const ResidentVolume&) = delete;

  /// Returns the volume's voxels, in index space.
  virtual const Box& voxels() const = 0;
  /// Opens the blocks of a box with sides that are multiples of 8. Every stream asked for must be of a block that lies
  /// wholly in the volume. Null if the volume has failed, has no room, or has most_open() boxes open already: the
  /// caller then reads the values.
  virtual std::unique_ptr<ResidentBlocks> open(const Box& blocks) = 0;
  /// Opens rows of blocks along x as a single set: at least one row, all equally long and one block thick. The blocks
  /// are numbered row after row. They are only surveyed: no stream may be asked for. Counts as one box. Null as for
  /// open().
  virtual std::unique_ptr<ResidentBlocks> open_rows(std::span<const Box> rows) = 0;
  /// Returns how many boxes may be open at a time.
  virtual std::size_t most_open() const = 0;

  /// Returns, for each i < bins, the number of finite values v with floor(v * 2^-exponent) - base = i. Every finite
  /// value must have an i < bins. Nullopt if that has failed.
  virtual std::optional<std::vector<std::uint64_t>> count(int exponent, double base, std::size_t bins) = 0;

  /// Allocates the memory for the streams of `regions` regions of 128^3 voxels that are encoded together. Call it while
  /// the volume has nothing else to do. A hint: reports no error.
  virtual void expect_streams(std::size_t regions) = 0;
  /// Frees memory that is not in use; later calls allocate it again.
  virtual void free_memory() = 0;

  /// Reads the values of a box inside the volume, x fastest. Throws Error(io).
  virtual void read(const Box& box, std::span<float> values) = 0;

  /// Returns the most bytes of the process's memory that it takes.
  virtual std::uint64_t host_bytes() const = 0;
};

}  // namespace weir
