// Known formats that weir does not read: such a file is no raw volume of an unknown extent.
#pragma once

#include "ingest/files/input_file.h"

namespace weir {

/// Throws Error(input), saying what `file` is and what to do, where its first bytes or its name are those of TIFF,
/// DICOM, MRC, FreeSurfer (.mgz, .mgh), parallel VTK images (.pvti) or XDMF, or where it has the values of a NIfTI or
/// Analyze header beside it (.img and .hdr).
void refuse_foreign_format(InputFile& file);

}  // namespace weir
