// Grid::render(): a picture from the renderer of `weir render`, as an array.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bindings/python/grid.h"
#include "bindings/python/watch.h"
#include "gpu/image/image_output.h"
#include "tools/options/picture_options.h"
#include "tools/plot/color_bar.h"
#include "tools/report/quantity_title.h"

namespace weir::python {

namespace py = pybind11;

namespace {

py::array linear_pixels(const Image& image) {
  py::array_t<float> array({image.height, image.width, 3});
  float* channel = array.mutable_data();
  for (const Float3& pixel : image.pixels) {
    *channel++ = pixel.x;
    *channel++ = pixel.y;
    *channel++ = pixel.z;
  }
  return array;
}

py::array display_pixels(const Picture& picture) {
  const std::vector<std::uint8_t> pixels = encode_rgb24(picture.image, picture.tone);
  py::array_t<std::uint8_t> array({picture.image.height, picture.image.width, 3});
  std::copy(pixels.begin(), pixels.end(), array.mutable_data());
  return array;
}

}  // namespace

py::array Grid::render(const GivenOptions& options, bool linear, const py::object& progress) const {
  const auto file = with_file("render");
  Picture picture;
  run_watched(progress, [&](Watch& watch) {
    file->require_unchanged();
    PictureRequest request = read_picture_request(options);
    request.sampling.cancel = &watch.cancelled();
    request.sampling.progress = [&](std::uint64_t done) { watch.advance(done); };
    const std::unique_ptr<Backend> backend =
        make_backend(request.backend, [&](const Message& line) { watch.notice(line); });
    const std::unique_ptr<LoadedVolume> volume = backend->load(file->file, 0, nullptr);
    std::optional<Image> bar;
    if (request.colorbar) {
      bar = draw_color_bar(picture_transfer(volume->info(), request.scene, request.options),
                           quantity_title(*file->file), request.options.height);
    }
    watch.start("render", request.pixel_samples());
    picture = backend->render(*volume, request.scene, request.options, request.sampling);
    if (bar) picture = with_color_bar(picture, *bar);
    for (const std::string& note : {picture.memory_note, picture.levels_note}) {
      if (!note.empty()) watch.notice(note);
    }
  });
  return linear ? linear_pixels(picture.image) : display_pixels(picture);
}

}  // namespace weir::python
