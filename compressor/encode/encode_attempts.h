// Encodes a surveyed volume into a file whose leaves are written: once for a size, as often as needed for an error
// target.
#pragma once

#include <memory>
#include <string>

#include "compressor/encode/finished_regions.h"
#include "compressor/encode/layer_encoder.h"
#include "compressor/encode/leaf_errors.h"
#include "compressor/encode/leaf_record.h"
#include "compressor/resume/journal.h"
#include "compressor/resume/work_directory.h"
#include "compressor/select/encoding_choice.h"
#include "compressor/survey/row_store.h"
#include "format/base/message.h"
#include "format/io/mapped_writes.h"
#include "format/output/output_files.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A file whose leaves are written, and what they lose.
struct EncodedFile {
  FilePlan file;
  std::unique_ptr<PackedTarget> packed;  ///< of a packed file
  DecodedErrors errors;
  DecodedErrors seen_errors;             ///< of those that can be seen
  std::unique_ptr<MappedWrites> mapped;  ///< the volume, to be written and read by; null where it is not mapped
  std::unique_ptr<RecordStore> records;  ///< of the leaves; null where `regions` are finished
  std::unique_ptr<FinishedRegions> regions;
};

/// Of a file whose leaves are written.
TreeParts tree_parts(const EncodedFile& encoded, const RowStore& rows);

/// What the attempts work with; all of it outlives them.
struct EncodeJob {
  VolumeSource& source;
  const BlockPlan& plan;
  Reading reading;
  const RowStore& rows;
  WorkDirectory& work;
  OutputFiles& output;
  Journal* journal;  ///< null: what is interrupted is lost
  std::string seen;  ///< visible_values of the scene; empty without one
  const StreamOptions& stream;
  std::function<void()> pass_started;                ///< may throw Error(interrupted)
  Notice notice;                                     ///< may be empty
  std::function<void(std::uint64_t bytes)> planned;  ///< may be empty
  /// Called where the cut of a plan lies outside the request's window: builds other ladders and sets their window.
  std::function<void(FileRequest&, double cut)> move_window;
  BlockCoder* coder = nullptr;  ///< of packed blocks
  std::uint64_t memory = 0;     ///< that the process may take
};

/// Plans, encodes and, where an error target is missed or left far behind, does so again with another expected error.
/// Where the default rate gave way to more than the encoding can keep, it is that rate's file in the end.
EncodedFile encode_file(const EncodeJob& job, FileRequest request);

}  // namespace weir
