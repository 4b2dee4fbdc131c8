#include "compressor/leaf/encoding.h"

#include "format/base/error.h"

namespace weir {

std::string encoding_name(Encoding encoding) {
  switch (encoding) {
    case Encoding::automatic:
      return "auto";
    case Encoding::float32:
      return "float";
    case Encoding::fpn:
      return "fpn";
    case Encoding::fp4:
      return "fp4";
    case Encoding::fp8:
      return "fp8";
    case Encoding::fp16:
      return "fp16";
    case Encoding::packed:
      return "packed";
  }
  throw Error(ErrorKind::internal, "unknown encoding");
}

GridType grid_type_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::float32:
    case Encoding::packed:
      return GridType::float32;
    case Encoding::fpn:
      return GridType::fpn;
    case Encoding::fp4:
      return GridType::fp4;
    case Encoding::fp8:
      return GridType::fp8;
    case Encoding::fp16:
      return GridType::fp16;
    case Encoding::automatic:
      break;
  }
  throw Error(ErrorKind::internal, "the encoding is not decided");
}

}  // namespace weir
