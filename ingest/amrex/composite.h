// The grid that the levels of a plotfile make together, read box by box: each cell of the wanted level has the value of
// the finest level that has cells there. Or the grid of one level, without what finer ones have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ingest/amrex/fab_reader.h"
#include "ingest/amrex/plotfile.h"
#include "ingest/source/repeated_part.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/upsampling.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Thread-safe. Holds no values but those of a read in progress.
class Composite {
 public:
  /// Of the component of this position, at the finest level that `plotfile` was opened with. `plotfile` outlives the
  /// object. `notice` is for RangeCheck.
  Composite(const Plotfile& plotfile, std::size_t component, const ValueMapping& mapping, Upsampling upsampling,
            DirectIo mode, const Notice& notice);
  /// Of the level `own` alone: what own_parts leaves out reads missing_value().
  Composite(const Plotfile& plotfile, std::size_t component, const ValueMapping& mapping, std::size_t own,
            DirectIo mode, const Notice& notice);

  /// Reads `box` of the wanted level's domain, which begins at 0; x fastest. Of linear values, loss is that of the
  /// cells that are read as they are stored; but values that stand for "no data" and are kept are counted in any case.
  /// Throws what InputFile and FabFiles throw.
  ConversionLoss read(const Box& box, std::span<float> values);

  /// As VolumeSource has them. What coarser levels have repeats where values are constant in their cells.
  std::vector<Box> voxels_with_values(const Box& box) const;
  std::vector<RepeatedPart> repeated_parts(const Box& box) const;
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values);

  /// What a read takes at most besides the caller's values and kStagingBytes.
  std::uint64_t working_bytes() const;
  std::uint64_t bytes_read() const { return reader_.bytes_read(); }

 private:
  /// The parts of `box`, of cells of `level`, by levels up to that one.
  std::vector<CoverPart> composite_parts(std::size_t level, const Box& box) const;
  /// The parts of `box`, whose `values` are set where no part is.
  std::vector<CoverPart> parts_of(const Box& box, std::span<float> values) const;
  ConversionLoss read_constant(const Box& box, std::span<float> values);
  ConversionLoss read_linear(const Box& box, std::span<float> values);
  /// One tile of a composite of linear values after `mapping`, what is between coarse cells after coarse_mapping_; by
  /// the calling thread alone.
  ConversionLoss read_tile(std::size_t level, const Box& box, const ValueMapping& mapping, std::span<float> values);
  /// Gives the missing voxels of `part` of the box `box` kept_value_; counts them.
  std::uint64_t keep_missing(const Box& part, const Box& box, std::span<float> values) const;

  const Plotfile& plotfile_;
  std::size_t wanted_;
  Upsampling upsampling_ = Upsampling::constant;
  bool own_ = false;  ///< the wanted level alone
  ValueMapping mapping_;
  ValueMapping coarse_mapping_;         ///< of cells between which there are linear values: "no data" is never kept
  float kept_value_ = missing_value();  ///< what "no data" reads as
  FabReader reader_;
};

}  // namespace weir
