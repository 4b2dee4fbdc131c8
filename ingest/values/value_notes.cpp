#include "ingest/values/value_notes.h"

#include "format/base/text.h"

namespace weir {

std::string not_applied_note(std::string_view name) {
  return cat("its attribute ", name, " is not applied: values outside it count as data");
}

std::string unheld_note(std::string_view name, const StoredValue& value, ScalarType type) {
  if (holds(type, value)) return "";
  return cat("its attribute ", name, " is ", stored_value_text(value), ", and no ", scalar_name(type),
             " is, so it marks no voxel; --missing names the stored value that stands for no data");
}

void add_note(const std::string& note, std::string& notes) {
  if (!note.empty()) notes += cat(notes.empty() ? "" : "; ", note);
}

}  // namespace weir
