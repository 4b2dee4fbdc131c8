// Options in messages of the C library have the names of weir.h.
#include "bindings/c/wording.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "compressor/options/conversion_request.h"
#include "format/base/ascii.h"
#include "format/base/text.h"

namespace weir::c_wording_test {
namespace {

using c::c_wording;

std::string header() {
  std::ifstream file(WEIR_SOURCE_DIR "/bindings/c/weir.h");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// "WEIR_MISSING_CHUNKS_ERROR".
std::string enumerator(std::string_view key, std::string_view value) {
  return upper_case(cat("WEIR_", key_wording(option(key)), '_', value));
}

TEST(CWording, ChoiceThatTheHeaderHas_IsCalledByItsEnumerator) {
  const std::string declared = header();
  int found = 0;
  for (const auto table : {input_options(), method_options(), run_options()}) {
    for (const ConversionOption& choice : table) {
      for (const std::string& value : split(choice.row.argument, '|')) {
        const std::string name = enumerator(choice.row.key, value);
        if (declared.find(name + " = ") == std::string::npos) continue;
        ++found;
        EXPECT_EQ(c_wording(option(choice.row.key, value)), name);
      }
    }
  }
  EXPECT_GE(found, 36);
}

TEST(CWording, Budget_IsCalledByItsKindAndTheMemberThatHoldsIt) {
  for (const ConversionOption& budget : method_options()) {
    if (budget.row.group != "budget") continue;
    const std::string kind = enumerator("budget", key_wording(option(budget.row.key)));
    const std::string member = budget.row.key == "size" ? "size" : "budget";
    EXPECT_EQ(c_wording(option(budget.row.key)), budget.row.flag() ? kind : cat(member, " (", kind, ")"));
  }
}

}  // namespace
}  // namespace weir::c_wording_test
