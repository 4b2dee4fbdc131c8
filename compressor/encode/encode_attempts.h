// Encodes the leaves of a surveyed volume into a file: once for a size, as often as needed for an error target.
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

/// A file with all leaves written, and the errors of these leaves.
struct EncodedFile {
  FilePlan file;
  std::unique_ptr<PackedTarget> packed;  ///< null if the file is not packed
  DecodedErrors errors;
  DecodedErrors seen_errors;             ///< errors of the leaves that can be seen
  std::unique_ptr<MappedWrites> mapped;  ///< the mapped volume file, for writing and reading; null if it is not mapped
  std::unique_ptr<RecordStore> records;  ///< records of the leaves; null if `regions` has taken them
  std::unique_ptr<FinishedRegions> regions;
};

/// Returns the parts from which TreeWriter writes the rest of `encoded`.
TreeParts tree_parts(const EncodedFile& encoded, const RowStore& rows);

/// What encode_file() works with. All that it refers to must outlive the call.
struct EncodeJob {
  VolumeSource& source;
  const BlockPlan& plan;
  Reading reading;
  const RowStore& rows;
  WorkDirectory& work;
  OutputFiles& output;
  Journal* journal;  ///< if null, an interrupted conversion cannot be resumed
  std::string seen;  ///< visible_values of the scene; empty without a scene
  const StreamOptions& stream;
  std::function<void()> pass_started;                ///< may throw Error(interrupted)
  Notice notice;                                     ///< may be empty
  std::function<void(std::uint64_t bytes)> planned;  ///< may be empty
  /// Called if the cut of a plan lies outside the request's window. Builds other ladders and sets their window.
  std::function<void(FileRequest&, double cut)> move_window;
  BlockCoder* coder = nullptr;  ///< coder for packed blocks; may be null
  std::uint64_t memory = 0;     ///< bytes that the process may use
};

/// Plans and encodes a file. If the file misses an error target, or is far better than the target, plans and encodes it
/// again with another expected error. If the default rate was raised to a quality that the encoding cannot reach, the
/// result is the file of the default rate.
EncodedFile encode_file(const EncodeJob& job, FileRequest request);

}  // namespace weir
