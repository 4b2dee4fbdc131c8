// The entry point of weir_plot.so, and all code that is compiled against cairo.
#include <cairo-svg.h>
#include <cairo.h>

#include <cstring>

#include "format/base/error.h"
#include "format/base/utf8.h"
#include "ingest/drivers/driver.h"
#include "tools/plot/plot_canvas.h"

namespace weir {
namespace {

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// Returns `text` with bytes that are not UTF-8 as "?", because a file's name may hold any bytes and cairo draws
/// nothing of invalid text.
std::string valid_utf8(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const bool control = static_cast<unsigned char>(text.front()) < ' ';
    const std::size_t good = control ? 0 : utf8_bytes(text);
    valid += good > 0 ? text.substr(0, good) : "?";
    text.remove_prefix(good > 0 ? good : 1);
  }
  return valid;
}

class CairoCanvas final : public PlotCanvas {
 public:
  CairoCanvas(std::int32_t width, std::int32_t height, PlotFormat format, const Float3& paper)
      : surface_(format == PlotFormat::png ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)
                                           : cairo_svg_surface_create_for_stream(append, &bytes_, width, height)),
        cairo_(cairo_create(surface_.get())),
        format_(format) {
    if (format == PlotFormat::svg) cairo_svg_surface_set_document_unit(surface_.get(), CAIRO_SVG_UNIT_PX);
    fill(0, 0, width, height, paper);
  }

  void fill(double x0, double y0, double x1, double y1, const Float3& ink) override {
    set(ink);
    cairo_rectangle(cairo_.get(), x0, y0, x1 - x0, y1 - y0);
    cairo_fill(cairo_.get());
  }

  void line(const PlotPoint& from, const PlotPoint& to, double width, const Float3& ink) override {
    set(ink);
    cairo_set_line_cap(cairo_.get(), CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(cairo_.get(), width);
    cairo_move_to(cairo_.get(), from.x, from.y);
    cairo_line_to(cairo_.get(), to.x, to.y);
    cairo_stroke(cairo_.get());
  }

  void polygon(std::span<const PlotPoint> corners, double width, const Float3& inside, const Float3& outline) override {
    cairo_new_path(cairo_.get());
    for (const PlotPoint& corner : corners) cairo_line_to(cairo_.get(), corner.x, corner.y);
    cairo_close_path(cairo_.get());
    set(inside);
    cairo_fill_preserve(cairo_.get());
    set(outline);
    cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(cairo_.get(), width);
    cairo_stroke(cairo_.get());
  }

  void text(const PlotPoint& at, std::string_view text, double size, const Float3& ink, TextAnchor anchor,
            bool upwards) override {
    const double width = text_width(text, size);
    const double left = anchor == TextAnchor::left ? 0 : anchor == TextAnchor::right ? -width : -width / 2;
    cairo_font_extents_t font;
    cairo_font_extents(cairo_.get(), &font);
    set(ink);
    cairo_save(cairo_.get());
    cairo_translate(cairo_.get(), at.x, at.y);
    if (upwards) cairo_rotate(cairo_.get(), -1.5707963267948966);
    cairo_move_to(cairo_.get(), left, (font.ascent - font.descent) / 2);
    cairo_show_text(cairo_.get(), valid_utf8(text).c_str());
    cairo_restore(cairo_.get());
  }

  double text_width(std::string_view text, double size) override {
    cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_.get(), size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_.get(), valid_utf8(text).c_str(), &extents);
    return extents.x_advance;
  }

  std::vector<std::uint8_t> rgb24() override {
    if (format_ != PlotFormat::png) throw Error(ErrorKind::internal, "a chart as SVG has no pixels");
    cairo_surface_flush(surface_.get());
    const int width = cairo_image_surface_get_width(surface_.get());
    const int height = cairo_image_surface_get_height(surface_.get());
    const unsigned char* data = cairo_image_surface_get_data(surface_.get());
    if (data == nullptr) throw Error(ErrorKind::internal, "a chart has no pixels");
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) {
      const unsigned char* row = data + static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_.get());
      for (int x = 0; x < width; ++x) {
        std::uint32_t pixel = 0;  // 0x00RRGGBB
        std::memcpy(&pixel, row + 4 * static_cast<std::ptrdiff_t>(x), sizeof pixel);
        for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(pixel >> shift & 0xFFU));
      }
    }
    return bytes;
  }

  std::string finish() override {
    if (format_ == PlotFormat::png) cairo_surface_write_to_png_stream(surface_.get(), append, &bytes_);
    const cairo_status_t drawing = cairo_status(cairo_.get());
    cairo_surface_finish(surface_.get());
    const cairo_status_t status = drawing != CAIRO_STATUS_SUCCESS ? drawing : cairo_surface_status(surface_.get());
    if (status != CAIRO_STATUS_SUCCESS) {
      throw Error(ErrorKind::internal, cat("a chart cannot be drawn: ", cairo_status_to_string(status)));
    }
    return std::move(bytes_);
  }

 private:
  void set(const Float3& ink) {
    cairo_set_source_rgb(cairo_.get(), static_cast<double>(ink.x), static_cast<double>(ink.y),
                         static_cast<double>(ink.z));
  }

  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };
  std::string bytes_;  // declared before the surface, which writes to it
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> cairo_;
  PlotFormat format_;
};

std::unique_ptr<PlotCanvas> make(std::int32_t width, std::int32_t height, PlotFormat format, const Float3& paper) {
  return std::make_unique<CairoCanvas>(width, height, format, paper);
}

}  // namespace
}  // namespace weir

WEIR_DRIVER_ENTRY;
WEIR_DRIVER_ENTRY {
  static constexpr weir::PlotDriver kDriver{weir::make};
  return &kDriver;
}
