#include "tools/view/jpeg_picture.h"

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include <cstdlib>
#include <memory>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// The error state of libjpeg. on_error() jumps to `back`, because the library would end the process if it returned.
struct JpegErrors {
  jpeg_error_mgr base;  // first: the library hands out a pointer to it
  std::jmp_buf back;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void on_error(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->message);
  std::longjmp(errors->back, 1);
}

struct JpegBytes {
  unsigned char* bytes = nullptr;  // allocated with malloc
  unsigned long size = 0;
};

// Must hold no object with a destructor, because longjmp would skip it. Returns false on failure; errors.message says
// why.
bool compress(const std::uint8_t* rows, std::int32_t width, std::int32_t height, int quality, JpegErrors& errors,
              JpegBytes& out) {
  jpeg_compress_struct info{};
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = on_error;
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &out.bytes, &out.size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.comp_info[0].h_samp_factor = 1;
  info.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPROW>(rows + std::size_t{info.next_scanline} * info.image_width * 3);  // read only
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

}  // namespace

bool has_jpeg() { return true; }

std::vector<std::byte> encode_jpeg(const Image& image, const ToneMapping& tone, int quality) {
  const std::vector<std::uint8_t> rows = encode_rgb24(image, tone);
  JpegErrors errors{};
  JpegBytes out;
  const bool done = compress(rows.data(), image.width, image.height, quality, errors, out);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(out.bytes, &std::free);
  if (!done) throw Error(ErrorKind::internal, cat("libjpeg: ", static_cast<const char*>(errors.message)));
  const auto* first = reinterpret_cast<const std::byte*>(out.bytes);
  return {first, first + out.size};
}

}  // namespace weir
