// Refuses files of known formats that weir does not read, so that they are not taken for raw volumes of an unknown
// extent.
#pragma once

#include "ingest/files/input_file.h"

namespace weir {

/// Throws Error(input), saying what `file` is and what to do, in two cases. One: its first bytes or its name are
/// those of TIFF, DICOM, MRC, FreeSurfer (.mgz, .mgh), parallel VTK images (.pvti) or XDMF. Two: it holds the values
/// of a NIfTI or Analyze header beside it (.img and .hdr).
void refuse_foreign_format(InputFile& file);

}  // namespace weir
