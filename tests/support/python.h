// Runs Debian's python3 with its packages, to write files with the libraries that other people use.
#pragma once

#include <cstdlib>
#include <string>

namespace weir {

/// The path of Debian's own interpreter. Another interpreter in PATH would not see the packages of tools/setup.sh.
inline const std::string kPython = "/usr/bin/python3";

inline bool python_has(const std::string& modules) {
  return std::system((kPython + " -c 'import " + modules + "' 2>/dev/null").c_str()) == 0;
}

/// Runs `script`, which must hold no single quote, with sys.argv[1] = `argument`. Returns whether it succeeded.
inline bool run_python(const std::string& script, const std::string& argument) {
  return std::system((kPython + " -c '" + script + "' '" + argument + "'").c_str()) == 0;
}

}  // namespace weir
