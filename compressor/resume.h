// Which conversions can be continued, and the notices about it. resume/journal.h says what is saved of them, and when.
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

/// Returns whether an interrupted conversion can be continued. `in_memory`: the output lies on a memory file system.
bool is_resumable(const SourceInfo& info, const ConversionOptions& options, bool in_memory);

/// Throws Error(usage) for Resume::on if the output lies on a memory file system, which keeps nothing.
void require_lasting_output(const ConversionOptions& options, bool in_memory);

/// Returns the journal of a conversion, with the state that an interrupted conversion saved. Returns null if the output
/// is in memory, or if `options` or the volume's size rule out continuing. Saved state is then removed, with a notice.
/// Throws as require_lasting_output() does.
std::unique_ptr<Journal> open_journal(const SourceInfo& info, const ConversionOptions& options,
                                      const ConversionControl& control, const OutputFiles& output, FileSystem& files);

/// Removes everything that conversions of `output` keep beside it, under the output's lock. It removes work that could
/// be continued, too, so call it only for an output that is known to be done. Returns false if nothing was removed.
/// Throws Error(io) if another process has the lock.
bool discard_all_beside(FileSystem& files, const std::string& output);

/// Calls discard_all_beside() if the last commit of `output` was completed but its process was killed before it had
/// tidied up. Otherwise removes at most an empty work directory.
void clear_after_commit(FileSystem& files, const std::string& output);

/// Returns "OUT.nvdb: continues a conversion that was interrupted, survey 100 %, encode 37 % done".
std::string continued_notice(const std::string& output, const Checkpoint& state, std::int64_t leaves);

/// Saves the finished work after `error`, or discards it if the same conversion would fail in the same way. Returns
/// the error to report.
Error ended_with(const Error& error, Journal& journal);

}  // namespace weir
