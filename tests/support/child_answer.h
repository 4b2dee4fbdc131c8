// Runs a measurement in a process of its own. A test of memory needs a process that did nothing before.
#pragma once

#include <functional>
#include <string>

namespace weir {

/// Runs `measure` in a copy of this process. Returns its answer (at most 200 characters) or the message of its
/// exception.
std::string answer_of_child(const std::function<std::string()>& measure);

}  // namespace weir
