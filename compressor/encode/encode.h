// The encode pass: reads the blocks that hold kept leaves, and only those, and
// writes every leaf at its place in the file.
#pragma once

#include <cstdint>

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/fill.h"
#include "compressor/leaf/quantised_leaf.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/survey/pauses.h"
#include "compressor/survey/row_store.h"
#include "format/base/box_set.h"
#include "format/base/trace.h"
#include "format/io/file_system.h"
#include "format/layout/nvdb_type.h"
#include "format/layout/tree_layout.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"

namespace weir {

struct EncodeTarget {
  const TreeRegions& tree;
  const ChoiceStore& choices;
  const TreeLayout& layout;
  Fill fill;
  GridType type;  ///< float32 or quantised
  Fit fit;        ///< of quantised leaves
  File& out;
  RecordStore& records;
  const RowStore& rows;  ///< of the survey; each rank of its team encodes the leaves of its own regions
  Trace* trace = nullptr;
};

/// Encodes all kept leaves; the bytes do not depend on the plan or the number of threads. `done`, where given, holds
/// the positions of the leaf lattice that are done already, by any plan; it is updated when `pauses` ask for it, and is
/// the whole lattice in the end. Throws Error(input) where the values of a leaf are not those that the survey saw.
void encode_leaves(VolumeSource& source, const BlockPlan& plan, const EncodeTarget& target,
                   const StreamOptions& options, Reading reading = Reading::ahead, BoxSet* done = nullptr,
                   const Pauses& pauses = {});

}  // namespace weir
