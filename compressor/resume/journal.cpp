#include "compressor/resume/journal.h"

#include <array>
#include <exception>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "compressor/resume/work_directory.h"
#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "format/io/output_names.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kJournal = "journal";
constexpr std::string_view kNewJournal = "journal.new";
constexpr std::string_view kVolume = "volume";
constexpr std::array<std::string_view, 4> kSpills{"rows", "faces", "ladders", "records"};

bool is_of_encoding(std::string_view name) { return name == "records" || name == kVolume; }

std::string in(const std::string& directory, std::string_view name) { return cat(directory, '/', name); }

// Returns the name of the output's spill directory. A digest of the whole path makes the name unique, because outputs
// of the same name may share one --work-dir.
std::string spill_name_of(const std::string& output) {
  const fs::path name = fs::path(output).filename();
  std::error_code ignored;
  const std::string whole = (fs::weakly_canonical(directory_of(output), ignored) / name).string();
  const std::string digest = piece_digest(std::as_bytes(std::span(whole))).hex().substr(0, 16);
  // Cuts the name, because the output's own name may already be the longest that a file system takes.
  std::string head = name.string().substr(0, 200);
  if (head.size() < name.string().size()) {  // does not cut inside a UTF-8 character
    while (!head.empty() && (static_cast<unsigned char>(name.string()[head.size()]) & 0xC0U) == 0x80U) head.pop_back();
  }
  return work_name(cat(head, '.', digest));
}

// Returns Checkpoint::spill_directory, an absolute path because the next process may have another working directory.
std::string spill_directory_for(const std::string& output, const std::string& work_dir) {
  if (work_dir.empty()) return {};
  std::error_code ignored;
  return (fs::absolute(work_dir, ignored).lexically_normal() / spill_name_of(output)).string();
}

// Returns whether the spill files that a checkpoint names belong to `output`. A journal that was moved with its output
// may name spill files that belong to another output by now.
bool has_own_spills(const Checkpoint& checkpoint, const std::string& output) {
  return checkpoint.spill_directory.empty() || fs::path(checkpoint.spill_directory).filename() == spill_name_of(output);
}

std::string place_in(const std::string& directory, const std::string& spills, std::string_view name) {
  return in(name == kVolume || spills.empty() ? directory : spills, name);
}

std::string spills_text(const std::string& spills) { return spills.empty() ? "beside the output" : spills; }

std::optional<Checkpoint> read_checkpoint(FileSystem& files, const std::string& path) {
  const std::unique_ptr<File> file = files.open(path);
  std::string text(file->size(), '\0');
  file->read_at(0, std::as_writable_bytes(std::span(text)));
  return parse_checkpoint(text);
}

// Opens and thereby locks the spill files in `spills`. Throws Error(io) if one of them is being written: another host
// or container may convert to the same path on its own disk with the same --work-dir.
std::vector<std::unique_ptr<File>> hold_spills(FileSystem& files, const std::string& spills) {
  std::vector<std::unique_ptr<File>> held;
  if (spills.empty()) return held;  // beside the output, which the caller has locked
  for (const std::string_view name : kSpills) {
    if (const std::string path = in(spills, name); files.exists(path)) held.push_back(files.open(path));
  }
  return held;
}

// Returns whether the files that a checkpoint depends on exist and have the sizes that it says.
bool stands(FileSystem& files, const std::string& directory, const Checkpoint& checkpoint) {
  for (const auto& [name, bytes] : checkpoint.files) {
    const std::string path = place_in(directory, checkpoint.spill_directory, name);
    if (!files.exists(path) || files.open(path)->size() != bytes) return false;
  }
  return true;
}

bool remove_present(FileSystem& files, const std::string& path) {
  if (!files.exists(path)) return false;
  files.remove(path);
  return true;
}

bool remove_all(FileSystem& files, const std::string& directory, const std::string& spills) {
  bool any = remove_present(files, in(directory, kJournal));
  any = remove_present(files, in(directory, kNewJournal)) || any;
  any = remove_present(files, in(directory, kVolume)) || any;
  for (const std::string_view name : kSpills) {
    any = remove_present(files, place_in(directory, spills, name)) || any;
  }
  return any;
}

// Describes the first entry in which two identities differ; empty if they are equal.
std::string difference(const ConversionIdentity& was, const ConversionIdentity& is) {
  for (const auto& [name, value] : is) {
    const auto at = was.find(name);
    if (at == was.end()) return cat(name, " was not given, now \"", value, '"');
    if (at->second != value) return cat(name, " was \"", at->second, "\", now \"", value, '"');
  }
  for (const auto& [name, value] : was) {
    if (!is.contains(name)) return cat(name, " was \"", value, "\", now not given");
  }
  return {};
}

// Returns the identity as it is after saving and reading, because JSON cannot hold every byte of a path.
ConversionIdentity as_saved(ConversionIdentity identity) {
  Checkpoint bare;
  bare.identity = std::move(identity);
  return parse_checkpoint(to_text(bare)).value().identity;
}

}  // namespace

Journal::Journal(FileSystem& files, const std::string& output, ConversionIdentity identity, JournalOptions options)
    : files_(files),
      output_(output),
      options_(std::move(options)),
      directory_(hidden_directory_of(output)),
      spill_directory_(spill_directory_for(output, options_.work_dir)) {
  identity = as_saved(std::move(identity));
  adopt(output, identity);
  files_.make_directory(directory_);
  if (!spill_directory_.empty()) {
    files_.make_directory(spill_directory_);
    hold_spill_directory();
  }
  state.identity = std::move(identity);
  state.spill_directory = spill_directory_;
}

// Opens and so locks "rows" in the spill directory, so that another conversion that comes there finds it locked.
void Journal::hold_spill_directory() {
  try {
    if (!open("rows")->has_its_name()) {  // removed by another process that began at the same moment
      throw Error(ErrorKind::io,
                  cat(path_of("rows"),
                      ": is being written by another process or conversion; wait for it or choose another output"));
    }
  } catch (const Error&) {
    remove_if_empty(files_, directory_);
    throw;
  }
}

// Returns whether the files of `found` exist with the right sizes. Keeps them open, and so locked, if they do.
bool Journal::adopts(const Checkpoint& found) {
  for (const auto& [name, bytes] : found.files) {
    if (files_.exists(path_of(name)) && open(name)->size() == bytes) continue;
    open_.clear();
    return false;
  }
  return true;
}

void Journal::adopt(const std::string& output, const ConversionIdentity& identity) {
  const std::string path = in(directory_, kJournal);
  std::string reason;
  if (files_.exists(path)) {
    std::optional<Checkpoint> found = read_checkpoint(files_, path);
    if (!found) {
      reason = "its journal is damaged or of another version of weir";
    } else if (reason = difference(found->identity, identity); !reason.empty()) {
    } else if (found->spill_directory != spill_directory_) {
      reason = cat("its spill files were in ", spills_text(found->spill_directory), ", now they go to ",
                   spills_text(spill_directory_));
    } else if (!adopts(*found)) {
      reason = "files that its journal names are missing or shorter";
    } else {
      state = std::move(*found);
      saved_ = state.files;
      return;
    }
  }
  remove_leftovers(files_, output);
  const auto held = hold_spills(files_, spill_directory_);
  remove_all(files_, directory_, spill_directory_);
  if (!reason.empty()) say_not_continued(reason);
}

void Journal::say_not_continued(const std::string& reason) {
  if (!options_.notice) return;
  options_.notice(cat(output_, ": an interrupted conversion of it is not continued: ", reason));
}

void Journal::forget(const std::string& reason) {
  say_not_continued(reason);
  remove_present(files_, in(directory_, kJournal));
  saved_.clear();
  Checkpoint anew;
  anew.identity = std::move(state.identity);
  anew.spill_directory = spill_directory_;
  state = std::move(anew);
}

Journal::~Journal() {
  try {
    wait();
  } catch (const std::exception&) {
    // The save before the failed one counts.
  }
  try {
    if (saved_.empty()) {
      discard();
      return;
    }
    remove_present(files_, in(directory_, kNewJournal));
    for (const auto& [name, file] : open_) {
      if (!saved_.contains(name)) files_.remove(path_of(name));
    }
  } catch (const Error&) {
    // The caller reports the failure that led here. The next conversion to this output removes what is left.
  }
}

std::string Journal::path_of(const std::string& name) const { return place_in(directory_, spill_directory_, name); }

std::vector<std::string> Journal::paths() const {
  std::vector<std::string> paths;
  for (const std::string_view name : {kJournal, kNewJournal, kVolume}) paths.push_back(in(directory_, name));
  for (const std::string_view name : kSpills) paths.push_back(path_of(std::string(name)));
  if (!spill_directory_.empty()) paths.push_back(spill_directory_);
  paths.push_back(directory_);
  return paths;
}

std::shared_ptr<File> Journal::open(const std::string& name) {
  std::shared_ptr<File>& file = open_[name];
  if (!file) file = files_.open(path_of(name));
  return file;
}

bool Journal::due() {
  if (options_.cancel != nullptr && *options_.cancel) return true;
  if (saving_.valid()) {
    if (saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    wait();
  }
  return seconds_since(last_save_) >= options_.interval_s;
}

void Journal::save() {
  wait();
  for (const auto& [name, file] : open_) {
    if (is_of_encoding(name) ? !state.encoded.done.empty() : !state.survey.done.empty())
      state.files[name] = file->size();
  }
  if (state.encoded.done.empty())
    std::erase_if(state.files, [](const auto& file) { return is_of_encoding(file.first); });
  last_save_ = Clock::now();
  saving_files_ = state.files;
  const bool waits = options_.interval_s == 0 || (options_.cancel != nullptr && *options_.cancel);
  std::vector<std::shared_ptr<File>> open;
  for (const auto& [name, file] : open_) open.push_back(file);
  // Deferred if no thread can be started.
  saving_ = std::async(waits ? std::launch::deferred : std::launch::async | std::launch::deferred,
                       [this, open = std::move(open), text = to_text(state)] { write(open, text); });
  if (saving_.wait_for(std::chrono::seconds(0)) == std::future_status::deferred) wait();
}

void Journal::save_now() {
  save();
  wait();
}

void Journal::wait() {
  if (!saving_.valid()) return;
  saving_.get();
  saved_ = std::move(saving_files_);
}

// Does the numbered steps that the header describes.
void Journal::write(const std::vector<std::shared_ptr<File>>& open, const std::string& text) {
  const TraceSpan span(options_.trace, "save");
  for (const std::shared_ptr<File>& file : open) file->sync();  // 1
  {
    const std::unique_ptr<File> file = files_.create(in(directory_, kNewJournal));  // 2
    file->write_at(0, std::as_bytes(std::span(text)));
    file->sync();
  }
  files_.rename(in(directory_, kNewJournal), in(directory_, kJournal));  // 3
  for (const std::string& directory : {directory_, spill_directory_}) {  // 4
    if (directory.empty()) continue;
    files_.sync_directory(directory);
    if (!placed_) files_.sync_directory(directory_of(directory));
  }
  placed_ = true;
}

void Journal::discard() noexcept {
  try {
    wait();
  } catch (const std::exception&) {
    // The save is not needed any more.
  }
  saved_.clear();
  try {
    remove_all(files_, directory_, spill_directory_);
  } catch (const Error&) {
    // Only the result, or the failure that led here, matters. The next conversion to this output removes what is left.
  }
  open_.clear();  // unlocks last: another conversion that finds the files unlocked might begin there
  if (!spill_directory_.empty()) remove_if_empty(files_, spill_directory_);
  remove_if_empty(files_, directory_);
}

std::optional<Checkpoint> read_journal(FileSystem& files, const std::string& output) {
  const std::string directory = hidden_directory_of(output);
  const std::string path = in(directory, kJournal);
  if (!files.exists(path)) return std::nullopt;
  std::optional<Checkpoint> found = read_checkpoint(files, path);
  if (!found || !has_own_spills(*found, output) || !stands(files, directory, *found)) return std::nullopt;
  return found;
}

bool remove_leftovers(FileSystem& files, const std::string& output) {
  const std::string directory = hidden_directory_of(output);
  const std::string path = in(directory, kJournal);
  std::string spills;
  if (files.exists(path)) {
    const std::optional<Checkpoint> found = read_checkpoint(files, path);
    if (found && has_own_spills(*found, output)) spills = found->spill_directory;
  }
  auto held = hold_spills(files, spills);
  const bool any = remove_all(files, directory, spills);
  held.clear();
  if (!spills.empty()) remove_if_empty(files, spills);
  return any;
}

std::string leftovers_notice(const std::string& output) {
  return cat(output, ": what an interrupted conversion of it had left is removed");
}

}  // namespace weir
