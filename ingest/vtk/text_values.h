// Reads numbers that are written as text, as in VTK's ASCII files.
#pragma once

#include <cstdint>
#include <string>

#include "format/base/scalar_type.h"
#include "ingest/streams/spool_file.h"
#include "ingest/vtk/file_text.h"

namespace weir {

/// Reads `count` numbers that white space separates and writes them to `spool` as values of `type` in this machine's
/// byte order. Floating-point types accept nan and inf too. If `all` is set, nothing else may follow. Throws
/// Error(input), beginning with `where`, if a word is no number of that type or is longer than 400 characters (naming
/// its position), or if there are too few words.
void spool_text_values(FileText& text, std::uint64_t count, ScalarType type, bool all, SpoolFile& spool,
                       const std::string& where);

/// Reads `count` numbers from 0 to 1 and writes values from 0 to 255, as vtkDataReader::ReadCoScalars reads
/// COLOR_SCALARS: each number as float32, times 255, plus 0.5, cut to an integer. Throws like spool_text_values(),
/// and also for other numbers.
void spool_text_fractions(FileText& text, std::uint64_t count, SpoolFile& spool, const std::string& where);

}  // namespace weir
