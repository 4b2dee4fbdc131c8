#include "compressor/conversion_options.h"

#include "format/base/error.h"

namespace weir {

std::string metric_name(Metric metric) {
  switch (metric) {
    case Metric::sse:
      return "sse";
    case Metric::farthest:
      return "farthest";
    case Metric::closest:
      return "closest";
    case Metric::median:
      return "median";
  }
  throw Error(ErrorKind::internal, "unknown metric");
}

std::string fill_name(FillMode fill) { return fill == FillMode::mean ? "mean" : "background"; }

std::string preview_name(Preview preview) {
  switch (preview) {
    case Preview::automatic:
      return "auto";
    case Preview::on:
      return "on";
    case Preview::off:
      return "off";
  }
  throw Error(ErrorKind::internal, "unknown choice of a preview");
}

std::string policy_name(NonFinitePolicy policy) {
  switch (policy) {
    case NonFinitePolicy::error:
      return "error";
    case NonFinitePolicy::background:
      return "background";
    case NonFinitePolicy::keep:
      return "keep";
  }
  throw Error(ErrorKind::internal, "unknown policy for non-finite values");
}

std::string missing_policy_name(const ConversionOptions& options) {
  switch (options.missing) {
    case MissingPolicy::automatic:
      return options.non_finite == NonFinitePolicy::keep ? "nan" : policy_name(options.non_finite);
    case MissingPolicy::error:
      return "error";
    case MissingPolicy::background:
      return "background";
    case MissingPolicy::keep:
      return "keep";
  }
  throw Error(ErrorKind::internal, "unknown policy for missing values");
}

}  // namespace weir
