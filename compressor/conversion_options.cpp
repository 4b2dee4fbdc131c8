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

}  // namespace weir
