// The choices in the option table are the names that sidecars use.
#include <gtest/gtest.h>

#include <string>

#include "compressor/options/conversion_request.h"

namespace weir::method_options_test {
namespace {

template <typename NameOf>
void expect_choices_read_as_themselves(const std::string& key, const NameOf& name_of, GivenOptions given = {}) {
  for (const std::string& choice : split(conversion_option(key).argument, '|')) {
    given[key] = choice;
    EXPECT_EQ(name_of(read_conversion_request(given).conversion), choice) << key;
  }
}

TEST(MethodOptions, ChoicesReadAsThemselves) {
  using Options = ConversionOptions;
  expect_choices_read_as_themselves("encoding", [](const Options& o) { return encoding_name(o.encoding); });
  expect_choices_read_as_themselves("metric", [](const Options& o) { return metric_name(o.metric); });
  expect_choices_read_as_themselves("fill", [](const Options& o) { return fill_name(o.fill); });
  expect_choices_read_as_themselves("nonfinite", [](const Options& o) { return policy_name(o.non_finite); });
  expect_choices_read_as_themselves("brick", [](const Options& o) { return cat(o.brick); }, {{"metric", "median"}});
}

}  // namespace
}  // namespace weir::method_options_test
