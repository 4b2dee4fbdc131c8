// Which conversions can be continued, and what is said about it. resume/journal.h has what is kept of them, and when.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "compressor/conversion_control.h"
#include "compressor/conversion_options.h"
#include "compressor/resume/journal.h"
#include "format/base/error.h"
#include "format/io/file_system.h"
#include "format/output/output_files.h"

namespace weir {

/// Whether an interrupted conversion can be continued, with an output on a file system that is memory or not.
bool is_resumable(const SourceInfo& info, const ConversionOptions& options, bool in_memory);

/// Throws Error(usage) for Resume::on where the output's file system is memory, which keeps nothing.
void require_lasting_output(const ConversionOptions& options, bool in_memory);

/// The journal of a conversion, with what an interrupted one left in it. Null where `options` or the volume's size rule
/// out continuing; then what was left is removed, with a notice. Throws what require_lasting_output throws.
std::unique_ptr<Journal> open_journal(const SourceInfo& info, const ConversionOptions& options,
                                      const ConversionControl& control, const OutputFiles& output, FileSystem& files);

/// Removes all that conversions of `output` keep beside it, under the lock on it: work that could be continued, too, so
/// only for an output that is known to be done. False where nothing was removed. Throws Error(io) where another process
/// has the lock.
bool discard_all_beside(FileSystem& files, const std::string& output);

/// The same where the last commit of `output` was completed, but was killed before it had tidied up. Elsewhere removes
/// an empty work directory at most.
void clear_after_commit(FileSystem& files, const std::string& output);

/// "OUT.nvdb: continues a conversion that was interrupted, survey 100 %, encode 37 % done".
std::string continued_notice(const std::string& output, const Checkpoint& state, std::int64_t leaves);

/// After `error`, saves what is done, or discards it where the same conversion would fail the same way. Returns the
/// error to report.
Error ended_with(const Error& error, Journal& journal);

}  // namespace weir
