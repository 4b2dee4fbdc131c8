// What a finished conversion reports, to people and to the program that started the command.
#pragma once

#include <string>

#include "compressor/select/budget.h"
#include "format/base/error.h"
#include "format/sidecar/sidecar.h"
#include "tools/report/progress.h"

namespace weir {

/// Logs one line for people. `budget` is the budget that was asked for.
void say_converted(const Sidecar& sidecar, const Budget& budget, const std::string& output);

/// Announces the output to the program that started this command. `skipped`: an earlier run had already made it.
void announce_output(const ProgressOptions& progress, const std::string& output, bool skipped, const Sidecar& sidecar);

/// Announces `error`. Options are named as in a configuration file, because a service's options are set there.
void announce_failure(const ProgressOptions& progress, const Error& error);

}  // namespace weir
