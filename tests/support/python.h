// Files written by the libraries that other people use: Debian's python3 and its packages.
#pragma once

#include <cstdlib>
#include <string>

namespace weir {

/// Debian's own interpreter: another one first in PATH would not see the packages of tools/setup.sh.
inline const std::string kPython = "/usr/bin/python3";

inline bool python_has(const std::string& modules) {
  return std::system((kPython + " -c 'import " + modules + "' 2>/dev/null").c_str()) == 0;
}

/// Runs `script`, which holds no single quote, with sys.argv[1] = `argument`; whether it ended well.
inline bool run_python(const std::string& script, const std::string& argument) {
  return std::system((kPython + " -c '" + script + "' '" + argument + "'").c_str()) == 0;
}

}  // namespace weir
