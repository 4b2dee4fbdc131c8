#include "tools/report/volume_title.h"

#include <filesystem>

#include "format/base/printable.h"
#include "format/base/text.h"

namespace weir {

std::string chosen_text(const std::string& dataset, std::span<const std::int64_t> index, const std::string& component) {
  std::string text = dataset;
  const char* const at = dataset.empty() ? "at " : " at ";
  for (const std::int64_t& i : index) text += cat(&i == index.data() ? at : ",", i);
  if (!component.empty())
    text += cat(text.empty() ? "" : ", ", component == "magnitude" ? "" : "component ", component);
  return text;
}

std::string volume_title(const Sidecar::Source& source) {
  const std::string chosen = chosen_text(source.dataset, source.index, source.component);
  const std::string file = std::filesystem::path(source.path).filename().string();
  return printable(chosen.empty() ? file : cat(file, ' ', chosen));
}

}  // namespace weir
