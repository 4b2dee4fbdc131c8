#include "ingest/files/file_states.h"

#include <filesystem>
#include <span>

#include "format/base/text.h"

namespace weir {
namespace {

// The text of a time in digests, unchanged since version 0.1.
std::string seconds_and_rest(std::int64_t ns) { return cat(ns / 1'000'000'000, ' ', ns % 1'000'000'000); }

}  // namespace

void FileStates::add(const FileState& file, const std::string& named) {
  // A zero byte ends the name, because no name holds one.
  const std::string text = cat(std::filesystem::path(file.path).filename().string(), '\0', file.bytes, ' ',
                               seconds_and_rest(file.mtime_ns), ' ', seconds_and_rest(file.ctime_ns), ' ', named);
  states_.update(piece_digest(std::as_bytes(std::span(text))));
  files_ += named.empty() ? 1 : 2;
  all_.push_back(file);
}

std::string FileStates::digest() const { return files_ < 2 ? std::string() : states_.digest().hex(); }

}  // namespace weir
