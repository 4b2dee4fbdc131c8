// Numbers written as text, as VTK's files in ASCII have them.
#pragma once

#include <cstdint>
#include <string>

#include "format/base/scalar_type.h"
#include "ingest/streams/spool_file.h"
#include "ingest/vtk/file_text.h"

namespace weir {

/// Reads `count` numbers that white space separates and writes them to `spool` as values of `type` in this machine's
/// byte order; floating-point types take nan and inf too. Where `all`, nothing else may follow. Throws Error(input),
/// beginning with `where`, naming the position of a word that is no number of that type or is longer than 400
/// characters, or where there are too few.
void spool_text_values(FileText& text, std::uint64_t count, ScalarType type, bool all, SpoolFile& spool,
                       const std::string& where);

/// Reads `count` numbers from 0 to 1 and writes 0 to 255 for them, as vtkDataReader::ReadCoScalars reads COLOR_SCALARS:
/// each as float32, times 255, plus 0.5, cut to an integer. Throws as spool_text_values, also for other numbers.
void spool_text_fractions(FileText& text, std::uint64_t count, SpoolFile& spool, const std::string& where);

}  // namespace weir
