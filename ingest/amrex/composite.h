// The grid that the levels of a plotfile form together, read box by box: each cell of the wanted level has the value
// of the finest level that has cells there. Also the grid of a single level, without the cells that finer levels
// have.
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

/// Reads the grid of all levels or of one level. Thread-safe. Holds only the values of a read in progress.
class Composite {
 public:
  /// The grid of the component at this position, at the finest level that `plotfile` was opened with. `plotfile` must
  /// outlive this object. `notice` is for RangeCheck.
  Composite(const Plotfile& plotfile, std::size_t component, const ValueMapping& mapping, Upsampling upsampling,
            DirectIo mode, const Notice& notice);
  /// The grid of the level `own` alone. Cells that own_parts leaves out read as missing_value().
  Composite(const Plotfile& plotfile, std::size_t component, const ValueMapping& mapping, std::size_t own,
            DirectIo mode, const Notice& notice);

  /// Reads `box` of the wanted level's domain, which begins at 0; x fastest. With linear upsampling, the returned
  /// loss counts only the cells that are read as they are stored, and all "no data" values that are kept. Throws the
  /// errors of InputFile and FabFiles.
  ConversionLoss read(const Box& box, std::span<float> values);

  /// See VolumeSource. With constant upsampling, the values of coarser levels repeat in their cells.
  std::vector<Box> voxels_with_values(const Box& box) const;
  std::vector<RepeatedPart> repeated_parts(const Box& box) const;
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values);

  /// Returns the most memory that a read takes, without the caller's values and kStagingBytes.
  std::uint64_t working_bytes() const;
  std::uint64_t bytes_read() const { return reader_.bytes_read(); }

 private:
  /// Returns the parts of `box`, a box of cells of `level`, from the levels up to `level`.
  std::vector<CoverPart> composite_parts(std::size_t level, const Box& box) const;
  /// Returns the parts of `box`. Sets its `values` to missing_value() if some cells are in no part.
  std::vector<CoverPart> parts_of(const Box& box, std::span<float> values) const;
  ConversionLoss read_constant(const Box& box, std::span<float> values);
  ConversionLoss read_linear(const Box& box, std::span<float> values);
  /// Reads one tile with linear upsampling, by the calling thread alone. Stored values pass through `mapping`, the
  /// coarse cells between which values are interpolated through coarse_mapping_.
  ConversionLoss read_tile(std::size_t level, const Box& box, const ValueMapping& mapping, std::span<float> values);
  /// Sets the missing voxels of `part`, which lies in `box`, to kept_value_ and returns their number.
  std::uint64_t keep_missing(const Box& part, const Box& box, std::span<float> values) const;

  const Plotfile& plotfile_;
  std::size_t wanted_;
  Upsampling upsampling_ = Upsampling::constant;
  bool own_ = false;  ///< the grid of the wanted level alone
  ValueMapping mapping_;
  ValueMapping coarse_mapping_;         ///< for cells that are interpolated: never keeps "no data" as a value
  float kept_value_ = missing_value();  ///< the value that "no data" reads as
  FabReader reader_;
};

}  // namespace weir
