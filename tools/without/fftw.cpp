// Replaces tools/spectrum/block_transform.cpp in a build with WEIR_FFTW=OFF.
#include "format/base/error.h"
#include "tools/spectrum/block_transform.h"

namespace weir {

BlockTransform::BlockTransform(const Index3&) {
  throw Error(ErrorKind::usage, "this weir was built without FFTW; build it with -DWEIR_FFTW=ON");
}

void BlockTransform::run(std::span<double>, std::span<std::complex<double>>) const {}

bool has_fftw() { return false; }

}  // namespace weir
