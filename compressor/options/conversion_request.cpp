#include "compressor/options/conversion_request.h"

#include <array>

namespace weir {
namespace {

std::array<std::span<const ConversionOption>, 3> tables() { return {input_options(), method_options(), run_options()}; }

const OptionRow* find_row(std::string_view key) {
  for (const auto table : tables()) {
    for (const ConversionOption& option : table) {
      if (option.row.key == key) return &option.row;
    }
  }
  return nullptr;
}

/// Checks the options of the encoding that do not depend on the volume's values, before the volume is read.
void check_encoding(const ConversionOptions& options) {
  const Encoding encoding = options.encoding;
  if (encoding != Encoding::packed && options.backend == CoderChoice::cuda) {
    throw usage_error(compose(option("backend", "cuda"), " converts to ", option("encoding", "packed"),
                              " alone; give that, or use ", option("backend", "auto")));
  }
  if (encoding != Encoding::packed && options.preview != Preview::automatic) {
    throw usage_error(compose(option("preview", options.preview == Preview::on ? "on" : "off"), " is for ",
                              option("encoding", "packed"), "; give that, or leave out ", option("preview")));
  }
  if (encoding == Encoding::automatic || encoding == Encoding::float32) return;
  if (options.metric != Metric::sse) {
    throw usage_error(compose(option("encoding", encoding_name(encoding)), " selects by ", option("metric", "sse"),
                              " only; use ", option("encoding", "float")));
  }
  if (encoding == Encoding::packed && options.fill != FillMode::mean) {
    throw usage_error(compose(option("encoding", "packed"), " drops no block to the background; leave out ",
                              option("fill", "background")));
  }
}

/// Checks combinations of method options, which no option can check by itself.
void check_method(const GivenOptions& given, const ConversionOptions& options) {
  const auto encoding = given.find("encoding");
  if (given.contains("preset") && encoding != given.end() && encoding->second != "float") {
    throw usage_error(compose(option("preset", "paper"), " sets ", option("encoding"), "; leave one of them out"));
  }
  if (options.metric != Metric::sse && options.budget.by_error()) {
    const Message by =
        given.contains("preset") ? option("preset", "paper") : option("metric", metric_name(options.metric));
    throw usage_error(
        compose(by, " has no error target; ", option("psnr"), " and ", option("max-error"), " select by sse"));
  }
  check_encoding(options);
  if (options.budget.at_most && !options.budget.by_size()) {
    throw usage_error(compose(option("at-most"), " needs ", option("size"), " or ", option("rate")));
  }
  if (options.metric == Metric::sse && options.brick != 8) {
    throw usage_error(compose(option("brick", options.brick), " is for ", option("metric", "farthest"),
                              ", closest or median; sse chooses single leaves"));
  }
  if (options.missing == MissingPolicy::background && options.non_finite == NonFinitePolicy::keep) {
    throw usage_error(compose(option("nonfinite", "keep"), " keeps every NaN, and ",
                              option("missing-policy", "background"), " none of those that stand for \"no data\"; use ",
                              option("nonfinite", "background"), " or leave out ", option("missing-policy")));
  }
}

/// Refuses options that describe one volume together with Levels::separate. Each level has its own voxel size.
void check_levels(const GivenOptions& given, const SourceOptions& source) {
  if (source.levels != Levels::separate) return;
  for (const char* const key : {"upsample", "roi", "ghost", "spacing", "origin", "stack"}) {
    if (!given.contains(key)) continue;
    throw usage_error(compose(option(key), " is for one volume, and ", option("levels", "separate"),
                              " makes several; leave one of them out"));
  }
}

}  // namespace

bool is_conversion_option(std::string_view key) { return find_row(key) != nullptr; }

const OptionRow& conversion_option(std::string_view key) {
  const OptionRow* const row = find_row(key);
  if (row == nullptr) throw Error(ErrorKind::internal, cat("no option ", key));
  return *row;
}

void settle_gaps(const SourceOptions& source, ConversionOptions& options) {
  if (source.levels != Levels::separate) return;
  const bool kept = options.missing == MissingPolicy::keep || options.missing == MissingPolicy::error;
  if (!kept && options.non_finite != NonFinitePolicy::keep) {
    options.missing = MissingPolicy::background;
    return;
  }
  throw usage_error(compose(kept ? option("missing-policy", options.missing == MissingPolicy::keep ? "keep" : "error")
                                 : option("nonfinite", "keep"),
                            " does not go with ", option("levels", "separate"),
                            ", whose voxels without a value become the background; use background"));
}

std::vector<OptionRow> watch_options() {
  std::vector<OptionRow> rows;
  for (const auto table : {input_options(), method_options()}) {
    for (const ConversionOption& option : table) {
      if (option.row.key != "stack") rows.push_back(option.row);
    }
  }
  rows.push_back(conversion_option("backend"));
  return rows;
}

ConversionRequest read_conversion_request(const GivenOptions& options) {
  const GivenOptions given = without_empty(options);
  ConversionRequest request;
  request.conversion.encoding = Encoding::automatic;
  for (const auto table : tables()) read_options(table, given, request);
  check_method(given, request.conversion);
  check_levels(given, request.source);
  settle_gaps(request.source, request.conversion);
  request.source.memory = request.conversion.memory;
  return request;
}

}  // namespace weir
