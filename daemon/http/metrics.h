// The service's figures in the text format that Prometheus reads:
// https://prometheus.io/docs/instrumenting/exposition_formats/ (version 0.0.4).
#pragma once

#include <string>

#include "daemon/http/control.h"
#include "daemon/jobs/process_usage.h"

namespace weir {

/// Returns all metrics, each with its HELP and TYPE line. Names begin with weir_; units are seconds and bytes;
/// counters end in _total and count since the start of the process.
std::string metrics_text(const StatusView& status, const MetricsView& metrics, const ProcessUsage& usage);

}  // namespace weir
