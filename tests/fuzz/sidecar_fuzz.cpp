// libFuzzer target for the sidecar. Any text must parse or throw Error(input). A parsed sidecar is written as text that
// parses to the same sidecar.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "format/base/error.h"
#include "format/sidecar/sidecar.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  try {
    const std::string text = weir::to_json_text(weir::parse_sidecar(input, "fuzz.json"));
    if (weir::to_json_text(weir::parse_sidecar(text, "fuzz.json")) != text) std::abort();
  } catch (const weir::Error& error) {
    if (error.kind() != weir::ErrorKind::input) std::abort();
  }
  return 0;
}
