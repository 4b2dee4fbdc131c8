#include "ingest/source_registry.h"

#include <algorithm>
#include <array>

#include "ingest/box_source.h"
#include "ingest/input_file.h"

namespace weir {
namespace {

constexpr std::array kFormats{
    // A raw file has no magic: it is what no other format wants.
    SourceFormat{"raw", [](std::string_view, std::span<const std::byte>) { return true; },
                 [](const std::string& path, const SourceOptions& options) { return open_raw(path, options.raw); }},
};

}  // namespace

std::span<const SourceFormat> source_formats() { return kFormats; }

std::unique_ptr<VolumeSource> open_source(const std::string& path, const SourceOptions& options) {
  std::array<std::byte, kMagicBytes> bytes{};
  InputFile file(path, DirectIo::off);
  const auto head = std::span(bytes).first(std::min<std::uint64_t>(kMagicBytes, file.size()));
  file.read_buffered(0, head, ReadPath::through);

  const auto format =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const SourceFormat& f) { return f.recognises(path, head); });
  auto source = format->open(path, options);
  return options.roi ? crop_source(std::move(source), *options.roi) : std::move(source);
}

}  // namespace weir
