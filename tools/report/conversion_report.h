// What is said of a conversion at its end, to people and to the program that started the command.
#pragma once

#include <string>

#include "compressor/select/budget.h"
#include "format/base/error.h"
#include "format/sidecar/sidecar.h"
#include "tools/report/progress.h"

namespace weir {

/// One line for people. `budget` is what was asked for.
void say_converted(const Sidecar& sidecar, const Budget& budget, const std::string& output);

/// For the program that started this one. `skipped`: it was done already.
void announce_output(const ProgressOptions& progress, const std::string& output, bool skipped, const Sidecar& sidecar);

/// As a configuration names options: it is where they are set for a service.
void announce_failure(const ProgressOptions& progress, const Error& error);

}  // namespace weir
