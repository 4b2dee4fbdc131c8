// The token that clients of a server must know, and the file that holds it.
#pragma once

#include <string>
#include <string_view>

namespace weir {

/// The text of the file without white space at its end. Throws Error(input) "PATH: ..." where it is missing, or can be
/// read by everybody: that is no secret; Error(io) where the system does not let this user read it.
std::string read_token_file(const std::string& path);

/// Why `token` cannot be one, with the remedy; empty where it can.
std::string token_fault(std::string_view token);

/// A new one that nobody can guess: 256 random bits in hex. Throws Error(io) where the system gives none.
std::string make_token();

}  // namespace weir
