// Replaces tools/view/jpeg_picture.cpp in a build with WEIR_JPEG=OFF: all pictures of `weir view` are PNG.
#include "format/base/error.h"
#include "tools/view/jpeg_picture.h"

namespace weir {

bool has_jpeg() { return false; }

std::vector<std::byte> encode_jpeg(const Image&, const ToneMapping&, int) {
  throw Error(ErrorKind::internal, "this weir was built without JPEG; build it with -DWEIR_JPEG=ON");
}

}  // namespace weir
