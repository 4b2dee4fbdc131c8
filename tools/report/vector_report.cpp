#include "tools/report/vector_report.h"

#include "format/base/printable.h"
#include "format/base/text.h"

namespace weir {
namespace {

nlohmann::ordered_json quantity_json(const QuantityError& error) {
  nlohmann::ordered_json json{
      {"rms", error.rms}, {"source_rms", error.source_rms}, {"relative_rms", nullptr}, {"max_abs", error.max_abs}};
  if (error.relative_rms) json["relative_rms"] = *error.relative_rms;
  return json;
}

// The divergence of many fields is close to zero, so a relative error says little: the line names both rms values.
std::string quantity_text(const QuantityError& error, const std::string& units) {
  return cat("rms error ", short_number(error.rms), ", the source's rms ", short_number(error.source_rms),
             ", largest error ", short_number(error.max_abs), units.empty() ? "" : cat(" ", printable(units)),
             " per world unit\n");
}

}  // namespace

nlohmann::ordered_json vector_json(const VectorErrors& errors) {
  return {{"vorticity", quantity_json(errors.vorticity)},
          {"divergence", quantity_json(errors.divergence)},
          {"voxels", errors.voxels},
          {"left_out", errors.left_out}};
}

std::string vector_text(const VectorErrors& errors, const std::string& units) {
  std::string text = cat("vorticity  ", quantity_text(errors.vorticity, units), "divergence ",
                         quantity_text(errors.divergence, units));
  if (errors.left_out > 0) {
    text += cat("           ", errors.left_out, errors.left_out == 1 ? " voxel" : " voxels",
                " at or beside one that is not finite left out\n");
  }
  return text;
}

}  // namespace weir
