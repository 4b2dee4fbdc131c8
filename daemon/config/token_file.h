// The token that clients of a server must know, and the file that contains it.
#pragma once

#include <string>
#include <string_view>

namespace weir {

/// Returns the text of the file without white space at its end. Throws Error(input) "PATH: ..." if the file is
/// missing or everybody can read it (then the token is no secret); Error(io) if this user may not read it.
std::string read_token_file(const std::string& path);

/// Returns why `token` cannot be used, with the remedy; empty if it can.
std::string token_fault(std::string_view token);

/// Returns a new token that nobody can guess: 256 random bits in hex. Throws Error(io) if the system provides no
/// random bits.
std::string make_token();

}  // namespace weir
