// Recognises a file of another program where a result of weir is expected.
#pragma once

#include <string>

namespace weir {

/// Returns whether `path` is a regular file that is not called .nvdb and does not begin as NanoVDB. A damaged .nvdb is
/// not foreign: opening it reports what is wrong.
bool is_foreign_file(const std::string& path);

/// Throws Error(input), with the command that converts the file, if is_foreign_file().
void refuse_foreign_file(const std::string& path);

}  // namespace weir
