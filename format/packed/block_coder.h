// Where many packed blocks are looked at and encoded at a time: a device. What it gives has the bits that the host
// gives; what it leaves is for its caller to do. Made by who has a device; the conversion knows these interfaces alone:
// BlockCoder for values of the host, ResidentVolume for values that are on the device already.
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

/// Who surveys and encodes packed blocks. automatic: a CUDA device where one answers and there is memory for it, else
/// the CPU.
enum class CoderChoice : std::uint8_t { automatic, cpu, cuda };

/// Which near rungs of a ladder are looked at; floats in order too where all are, or where most values are zero.
struct NearAsk {
  NearBlocks blocks{};      ///< that have some
  bool all = true;          ///< else those about `wanted`
  std::int32_t wanted = 0;  ///< exponent of a quantum

  /// How many near rungs of each block are looked at, at most.
  WEIR_HOST_DEVICE std::uint32_t most() const {
    return blocks == NearBlocks::none ? 0U : all ? static_cast<std::uint32_t>(kNearRungs) : kAbout;
  }
  /// The first one of a ladder whose coarsest quantum has that exponent.
  WEIR_HOST_DEVICE std::uint32_t first(std::int32_t coarsest) const {
    if (all) return 0;
    constexpr std::int32_t kCoarser = 2;
    constexpr std::int32_t kLast = kNearRungs - static_cast<std::int32_t>(kAbout);
    const std::int32_t rung = near_rung_about(coarsest, wanted) - kCoarser;
    return static_cast<std::uint32_t>(rung < 0 ? 0 : rung > kLast ? kLast : rung);
  }
  /// A search among them hardly ever goes more than two to either side.
  static constexpr std::uint32_t kAbout = 6;
};

/// Keys between which the cut lies: squared error that a byte saves. Rungs that no search for such a cut comes to need
/// not be looked at.
struct SearchKeys {
  double low = 0;
  double high = 0;        ///< 0: all rungs are looked at
  bool compares = false;  ///< whether rungs or near rungs that are far behind the others are left out

  WEIR_HOST_DEVICE bool known() const { return high > 0; }
};

/// Which rungs of a ladder are looked at.
struct RungAsk {
  bool all = true;          ///< from kLadderMeanRungs on; else those about `wanted`
  std::int32_t wanted = 0;  ///< step
  NearAsk near{};
  SearchKeys keys{};

  /// How many rungs of each block are looked at, at most.
  WEIR_HOST_DEVICE std::uint32_t most() const {
    return all ? static_cast<std::uint32_t>(kLadderRungs - kLadderMeanRungs) : kRungsAbout;
  }
  /// The rung that a search about `wanted` begins at, of a ladder whose first step is that.
  WEIR_HOST_DEVICE std::uint32_t start(std::int32_t first_step) const {
    return static_cast<std::uint32_t>(rung_about(first_step, wanted));
  }
  /// Whether it is known which cuts are searched for.
  WEIR_HOST_DEVICE bool searches() const { return !all && keys.known(); }
  /// The first one asked for.
  WEIR_HOST_DEVICE std::uint32_t first(std::int32_t first_step) const {
    constexpr std::uint32_t kFirst = kLadderMeanRungs;
    if (all) return kFirst;
    constexpr std::uint32_t kCoarser = 4;
    constexpr std::uint32_t kLast = kLadderRungs - kRungsAbout;
    const std::uint32_t about = start(first_step);
    return about < kFirst + kCoarser ? kFirst : about - kCoarser > kLast ? kLast : about - kCoarser;
  }
  /// A search among them goes four to the coarse side and three to the fine one.
  static constexpr std::uint32_t kRungsAbout = 8;
};

/// TransformBlock::cost() of a rung.
struct RungCost {
  double squared_error = 0;
  std::uint32_t bits = 0;  ///< 0: not looked at
  std::uint32_t unused = 0;
};

/// RoundedBlock::cost() of a near rung.
struct NearCost {
  double squared_error = 0;
  std::uint32_t bytes = 0;  ///< 0: not looked at
  std::uint32_t unused = 0;
};
/// NearCost::bytes of a rung that was looked at, but cannot be had.
inline constexpr std::uint32_t kNoNearBytes = ~0U;

/// What TransformBlock::set() finds of a block.
struct BlockFigures {
  double energy = 0;
  float mean = 0;
  float largest = 0;
  std::int16_t first_step = 0;   ///< of the ladder
  std::uint8_t first_rung = 0;   ///< of those asked for
  std::uint8_t rungs = 0;        ///< that were asked for
  std::uint8_t transformed = 0;  ///< 0: the values are too large or too small for that
  std::uint8_t lattice = 0;      ///< whether they may lie on a lattice; who has time looks closer
  std::uint8_t first_near = 0;   ///< of the near rungs asked for
  std::uint8_t near = 0;         ///< that were asked for
  /// Of the stream of floats in their own order, at most kRawStreamBytes; 0: not looked at.
  std::uint16_t ordered_bytes = 0;
  std::uint16_t unused[3] = {};
};

/// What a stream has.
enum class StreamAskKind : std::uint8_t {
  transform,  ///< coefficients, quantised at a step
  rounded,    ///< values rounded to multiples of 2^step
  exact       ///< every bit, in so many bytes, where the source's type does not say that values lie on a lattice
};

/// A stream to be written.
struct StreamAsk {
  MeanRange means;           ///< of the block's region
  std::uint32_t block = 0;   ///< of the box, x fastest
  std::uint32_t offset = 0;  ///< among all streams: behind the end of the ask before it, or further
  std::uint16_t bytes = 0;
  std::int16_t step = 0;
  StreamAskKind kind{};
};

/// What a survey finds of a block.
struct SurveyedBlock {
  const BlockFigures& figures;
  std::span<const RungCost> costs;  ///< RungAsk::most(), of rungs from figures.first_rung on
  std::span<const NearCost> near;   ///< NearAsk::most(), of near rungs from figures.first_near on
};

/// What a survey finds of all blocks, one after the other.
struct SurveyedBlocks {
  std::span<const BlockFigures> figures;
  std::span<const RungCost> costs;
  std::span<const NearCost> near;
  /// Of resident blocks alone, of each that lies wholly in the volume and whose values are all finite; of one whose
  /// values are not, `finite` alone.
  std::span<const BlockSummary> summaries;

  SurveyedBlock block(std::size_t at) const {
    const std::size_t rungs = costs.size() / figures.size();
    const std::size_t near_rungs = near.size() / figures.size();
    return {figures[at], costs.subspan(rungs * at, rungs), near.subspan(near_rungs * at, near_rungs)};
  }
};

/// Streams and what they decode to, by ask.
struct MadeStreams {
  std::span<std::byte> bytes;  ///< of all, where the asks say; what lies between may be anything, and is the caller's
  std::span<const float> decoded;      ///< 512 of each, in the order of a leaf; none of resident blocks
  std::span<const std::uint8_t> made;  ///< 0: the caller has to encode it
  // Of resident blocks alone.
  std::span<const LeafRecord> records;  ///< what the nodes above them need
  std::span<const Digest> sources;      ///< digests of their blocks' values
};

/// Streams that are being written.
class PendingStreams {
 public:
  PendingStreams() = default;
  virtual ~PendingStreams() = default;
  PendingStreams(const PendingStreams&) = delete;
  PendingStreams& operator=(const PendingStreams&) = delete;

  /// Waits for them; what it gives stays as long as the object. Nullopt where that has failed.
  virtual std::optional<MadeStreams> wait() = 0;
};

/// Values of a box, where the blocks of a volume are looked at. One thread uses it.
class LoadedBlocks {
 public:
  LoadedBlocks() = default;
  virtual ~LoadedBlocks() = default;
  LoadedBlocks(const LoadedBlocks&) = delete;
  LoadedBlocks& operator=(const LoadedBlocks&) = delete;

  /// Begins to look at all blocks of the box.
  virtual void begin_survey(const RungAsk& ask) = 0;
  /// Waits for it; what it gives stays as long as the object. Nullopt where that has failed.
  virtual std::optional<SurveyedBlocks> end_survey() = 0;

  /// Begins to write streams of some of its blocks, one ask at least; the object must stay until they are waited for.
  /// Null where that has failed.
  virtual std::unique_ptr<PendingStreams> encode(std::span<const StreamAsk> asks, const BlockConstants& constants) = 0;
};

/// Any threads may use it at once. A failure is said once; after it everything is left to the caller.
class BlockCoder {
 public:
  BlockCoder() = default;
  virtual ~BlockCoder() = default;
  BlockCoder(const BlockCoder&) = delete;
  BlockCoder& operator=(const BlockCoder&) = delete;

  /// Values over `voxels`, x fastest, of which `blocks` are the blocks' boxes together, multiples of 8 long; where that
  /// is larger, values outside are those of the nearest voxel inside. Null where it has failed, has no room, or has
  /// enough to do: the caller does the work then.
  virtual std::unique_ptr<LoadedBlocks> load(std::span<const float> values, const Box& voxels, const Box& blocks) = 0;

  /// What it takes of the process's memory while it works, at most, in bytes.
  virtual std::uint64_t host_bytes() const = 0;
};

/// Blocks of a resident volume. Streams are encoded once, after the survey: what end_survey() gave is gone then. What
/// is given of the streams stays as long as the blocks.
class ResidentBlocks : public LoadedBlocks {
 public:
  /// The values of some of them, 512 of each in the order of a leaf; outside the volume those of the nearest voxel
  /// inside. They stay until the next call. Nullopt where that has failed.
  virtual std::optional<std::span<const float>> values(std::span<const std::uint32_t> blocks) = 0;
};

/// A volume of float32 values, x fastest and without gaps, that lies where blocks are looked at: only what becomes of
/// them crosses the host's memory. Any threads may use it at once.
class ResidentVolume {
 public:
  ResidentVolume() = default;
  virtual ~ResidentVolume() = default;
  ResidentVolume(const ResidentVolume&) = delete;
  ResidentVolume& operator=(const ResidentVolume&) = delete;

  /// Its voxels, in index space.
  virtual const Box& voxels() const = 0;
  /// The blocks of a box, multiples of 8 long; every stream asked for must be of one that lies wholly in the volume.
  /// Null where it has failed, has no room, or has most_open() of them: the caller reads the values then.
  virtual std::unique_ptr<ResidentBlocks> open(const Box& blocks) = 0;
  virtual std::size_t most_open() const = 0;

  /// How many of its finite values v have floor(v * 2^-exponent) - base = i, by i < bins, which all of them have.
  /// Nullopt where that has failed.
  virtual std::optional<std::vector<std::uint64_t>> count(int exponent, double base, std::size_t bins) = 0;

  /// Gets the memory for streams of so many regions of 128^3 voxels, as far as they are asked for together: to be
  /// called while there is nothing else to do for it. A hint, no error.
  virtual void expect_streams(std::size_t regions) = 0;
  /// Frees what is not in use; later calls get it again.
  virtual void free_memory() = 0;

  /// Values over a box inside it, x fastest. Throws Error(io).
  virtual void read(const Box& box, std::span<float> values) = 0;

  /// What it takes of the process's memory, at most, in bytes.
  virtual std::uint64_t host_bytes() const = 0;
};

}  // namespace weir
