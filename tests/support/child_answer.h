// What a process of its own found: a test of memory wants one that did nothing before.
#pragma once

#include <functional>
#include <string>

namespace weir {

/// Runs `measure` in a copy of this process and returns its answer, of 200 characters at most, or what it threw.
std::string answer_of_child(const std::function<std::string()>& measure);

}  // namespace weir
