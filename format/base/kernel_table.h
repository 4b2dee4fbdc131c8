// Numbers in the text files of the Linux kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace weir {

/// Returns the number behind the word `key` in one of the kernel's tables; 0 if there is none.
std::uint64_t number_in_table(const std::string& path, const std::string& key);

/// Returns the number at the beginning of a file; nullopt if the file is missing or begins with a word ("max").
std::optional<std::uint64_t> number_in_file(const std::string& path);

}  // namespace weir
