// Numbers in the text files of the kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace weir {

/// The number behind the word `key` in one of the kernel's tables; 0 where there is none.
std::uint64_t number_in_table(const std::string& path, const std::string& key);

/// The number that a file begins with; nullopt where it is missing or says another word ("max").
std::optional<std::uint64_t> number_in_file(const std::string& path);

}  // namespace weir
