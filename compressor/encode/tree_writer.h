// After the leaves: writes the inner nodes, the macrocells and the head, so that
// the file is a NanoVDB grid.
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
  const RecordStore* records;  ///< null where regions are added as they are encoded
  Fill fill;
  TreeLayout layout;                     ///< padded to the file's size
  const PackedTarget* packed = nullptr;  ///< of a packed file
};

/// Writes everything but the leaves, and of a packed file the streams with their ends, to a file that has its size and
/// reads zero where nothing was written.
class TreeWriter {
 public:
  /// What `parts` refers to, and `out`, must outlive the object.
  TreeWriter(const TreeParts& parts, File& out);
  ~TreeWriter();
  TreeWriter(const TreeWriter&) = delete;
  TreeWriter& operator=(const TreeWriter&) = delete;

  /// What the tree has of a region, whose kept leaves have these records, in their order. Only where the parts have no
  /// records: then once for each region with kept leaves. Thread-safe for different regions.
  void add(std::int64_t region, std::span<const LeafRecord> records);
  /// The rest. `head` carries name, type, voxel size and origin; the rest of it is filled in. Returns the head's
  /// checksum.
  std::uint32_t finish(GridHead head);

 private:
  class Lowers;
  const TreeParts parts_;
  File& out_;
  std::unique_ptr<Lowers> lowers_;
};

}  // namespace weir
