#include "tools/report/quantity_title.h"

#include <optional>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

// Returns "density" for "/fields/density".
std::string last_part(const std::string& name) { return name.substr(name.rfind('/') + 1); }

std::string quantity_text(const std::string& long_name, const std::string& name, const std::string& units) {
  const std::string shown = long_name.empty() ? last_part(name) : long_name;
  if (units.empty()) return shown;
  return shown.empty() ? units : cat(shown, " (", units, ")");
}

}  // namespace

std::string quantity_title(const NvdbFile& file) {
  try {
    if (const std::optional<Sidecar> sidecar = own_sidecar(file)) {
      return quantity_text(sidecar->source.long_name, sidecar->grid.name, sidecar->source.units);
    }
  } catch (const Error&) {  // a missing title must not prevent a picture; `weir verify` reports the fault
  }
  return last_part(file.grid().name());
}

std::string quantity_title(const SourceInfo& source) {
  return quantity_text(source.details.long_name, source.dataset, source.units);
}

}  // namespace weir
