// Completes the file after its leaves are written: writes the inner nodes, the macrocells and the head, so that the
// file is a NanoVDB grid.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "compressor/encode/layer_encoder.h"
#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/fill.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"
#include "format/io/file_system.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/grid_head.h"

namespace weir {

struct TreeParts {
  const TreeRegions& tree;
  const RowStore& rows;
  const ChoiceStore& choices;
  const RecordStore* records;  ///< null if regions are added as they are encoded
  Fill fill;
  TreeLayout layout;                     ///< padded to the file's size
  const PackedTarget* packed = nullptr;  ///< null if the file is not packed
};

/// Writes everything except the leaves, or in a packed file except the streams and their ends. The file must already
/// have its size and read zero where nothing was written.
class TreeWriter {
 public:
  /// `out` and everything that `parts` refers to must outlive the object.
  TreeWriter(const TreeParts& parts, File& out);
  ~TreeWriter();
  TreeWriter(const TreeWriter&) = delete;
  TreeWriter& operator=(const TreeWriter&) = delete;

  /// Writes the tree's part of a region. `records` are the records of its kept leaves, in their order. Call it only if
  /// the parts have no records, and then once for each region with kept leaves. Thread-safe for different regions.
  void add(std::int64_t region, std::span<const LeafRecord> records);
  /// Writes the rest. `head` gives the name, type, voxel size and origin; finish() fills in its other members. Returns
  /// the head's checksum.
  std::uint32_t finish(GridHead head);

 private:
  class Lowers;
  const TreeParts parts_;
  File& out_;
  std::unique_ptr<Lowers> lowers_;
};

}  // namespace weir
