#include "ingest/hdf5/file/hdf5_error.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <new>
#include <string>

#include "format/base/text.h"

namespace weir {
namespace {

// The library calls this for each function of the failed call, the innermost first.
herr_t keep_first(unsigned /*depth*/, const H5E_error2_t* error, void* reason) {
  auto& text = *static_cast<std::string*>(reason);
  try {
    if (text.empty() && error->desc != nullptr) text = error->desc;
  } catch (const std::bad_alloc&) {  // must not pass through the library; the reason is left out
    return -1;
  }
  return 0;
}

}  // namespace

std::string hdf5_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  // Descriptions quote names from the file, which may hold control characters.
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, ' ');
  while (reason.ends_with(' ') || reason.ends_with('.')) reason.pop_back();
  return reason.empty() ? "no reason given" : reason;
}

std::string object_text(hid_t object) {
  std::array<char, 4096> file{};
  std::array<char, 4096> name{};
  H5Fget_name(object, file.data(), file.size() - 1);
  H5Iget_name(object, name.data(), name.size() - 1);
  return cat(file.data(), ": ", name.data());
}

Error hdf5_error(const std::string& where, const std::string& what) {
  return {ErrorKind::input, cat(where, ": ", what, ": ", hdf5_reason())};
}

}  // namespace weir
