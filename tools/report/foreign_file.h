// Whether a file that is to be a result of weir is another program's.
#pragma once

#include <string>

namespace weir {

/// Whether `path` is a file that can be looked at, is not called .nvdb and does not begin as NanoVDB. A damaged .nvdb
/// is none: what is wrong with it is said when it is opened.
bool is_foreign_file(const std::string& path);

/// Throws Error(input), which gives the command that converts it, where is_foreign_file().
void refuse_foreign_file(const std::string& path);

}  // namespace weir
