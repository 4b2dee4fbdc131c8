#include "daemon/watch/completion.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <span>
#include <string_view>

#include "daemon/store/file_identity.h"
#include "daemon/watch/file_writers.h"
#include "daemon/watch/source_identity.h"
#include "format/base/error.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "ingest/amrex/amrex_source.h"
#include "ingest/files/input_directory.h"
#include "ingest/raw/raw_name.h"
#include "ingest/source/extent.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

using State = CompletionAnswer::State;

constexpr const char* kHasWriter = "a program has it open for writing";

std::optional<Index3> extent_of(std::string_view dims) {
  const std::vector<std::string> parts = split(dims, dims.find('x') == std::string_view::npos ? ',' : 'x');
  if (parts.size() != 3) return std::nullopt;
  const auto x = parse_int(parts[0]);
  const auto y = parse_int(parts[1]);
  const auto z = parse_int(parts[2]);
  if (!x || !y || !z) return std::nullopt;
  return Index3{*x, *y, *z};
}

// Returns the size of `path` if it is a raw file of known shape. A shape that convert will refuse gives no size.
std::optional<std::uint64_t> expected_bytes(const WatchConfig& watch, const std::string& path) {
  const std::optional<RawName> name = parse_raw_name(path);
  const auto dims = watch.convert_option("dims");
  const auto type_name = watch.convert_option("type");
  const auto extent = dims ? extent_of(*dims) : name ? std::optional(name->extent) : std::nullopt;
  const auto type = type_name ? parse_scalar(split_byte_order(*type_name).name) : name ? name->type : std::nullopt;
  if (!extent || !type) return std::nullopt;
  try {
    const std::int64_t offset = parse_int(watch.convert_option("offset").value_or("0")).value_or(0);
    return checked_volume_bytes(*extent, scalar_bytes(*type), path) + static_cast<std::uint64_t>(offset);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// Checks the content, because other programs, and AMReX in its checkpoints, also write files called Header.
bool is_plotfile_header(const std::string& path) {
  std::array<char, kMagicBytes> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  const auto bytes = std::as_bytes(std::span(head)).first(static_cast<std::size_t>(file.gcount()));
  return recognises_amrex(path, bytes);
}

// Returns false if nothing is there.
bool look_at(const std::string& path, struct stat& status) {
  if (::stat(path.c_str(), &status) == 0) return true;
  if (says_missing(errno)) return false;
  throw io_error(path, "look at it", errno);
}

}  // namespace

CompletionRules completion_rules(const WatchConfig& watch, const std::string& path,
                                 const std::shared_ptr<StoreTurns>& turns) {
  CompletionRules rules;
  rules.policy = watch.complete;
  rules.settle = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(watch.settle_s));
  rules.expected_bytes = expected_bytes(watch, path);
  rules.marker = watch.marker;
  if (rules.policy == Completion::rename || rules.policy == Completion::close) {
    // An unreadable file counts as having no writer; its job reports the fault.
    rules.has_writer = [path] { return ::access(path.c_str(), R_OK) == 0 && FileWriters(path).some(); };
  }
  if (is_plotfile_head(path)) rules.unwritten = [path] { return unwritten_part(path); };
  if (is_store_head(path) && rules.policy != Completion::marker) {
    rules.store = std::make_shared<StoreQuiet>(std::string(named_by_head(path)), rules.settle, StoreTurn(turns, path));
  }
  return rules;
}

FileSample sample_file(const std::string& path, const std::string& marker,
                       const std::vector<std::string>& convert_options) {
  FileSample sample;
  struct stat status {};
  if (!look_at(path, status) || !S_ISREG(status.st_mode)) return sample;
  if (is_plotfile_head(path) && !is_plotfile_header(path)) return sample;
  // A hierarchy may have the metadata of both Zarr versions; only one of the two files is its head.
  if (is_store_head(path)) {
    if (head_in_directory(std::string(named_by_head(path))) != path) return sample;
    const auto identity = identify_source(path, convert_options);
    if (!identity) throw Error(ErrorKind::io, cat(path, ": its metadata cannot be looked at; looked at again"));
    sample.identity = *identity;
  } else {
    sample.identity = identity_of(status);
  }
  sample.exists = true;
  sample.marked = !marker.empty() && look_at(path + marker, status);
  return sample;
}

void FileCompletion::happened(FileEventKind kind, Time now) {
  const bool of_writer = kind == FileEventKind::written || kind == FileEventKind::closed;
  found_open_ = found_open_ && (of_writer || kind == FileEventKind::found);
  switch (kind) {
    case FileEventKind::found:  // a look also sees changes of a writer whose close will still be seen
      set_named(true);
      if (writer_ != Writer::open) writer_ = Writer::unknown;
      break;
    case FileEventKind::overflow:  // the close may be among the lost events
      writer_ = Writer::unknown;
      break;
    case FileEventKind::created:
      set_named(false);
      writer_ = Writer::begun;
      break;
    case FileEventKind::written:
      writer_ = Writer::open;
      unchanged_since_ = now;
      break;
    case FileEventKind::closed:
      writer_ = Writer::closed;
      unchanged_since_ = now;
      break;
    case FileEventKind::moved_in:
      set_named(true);
      writer_ = Writer::renamed;
      break;
    case FileEventKind::permitted:
    case FileEventKind::marked:
    case FileEventKind::removed:
    case FileEventKind::root_lost:
    case FileEventKind::root_back:
      break;
  }
}

void FileCompletion::source_before() {
  if (!created_) named_ = true;
}

void FileCompletion::set_named(bool named) {
  named_ = named;
  created_ = !named;
}

CompletionAnswer FileCompletion::look(const FileSample& sample, Time now) {
  CompletionAnswer answer = by_policy(sample, now);
  if (answer.state != State::complete) {
    if (rules_.store) rules_.store->stop();  // other hierarchies may take the turn
    return answer;
  }
  if (rules_.store) {
    StoreQuiet::Answer store = rules_.store->look(now);
    return store.quiet ? answer : CompletionAnswer{State::waiting, store.until, std::move(store.reason)};
  }
  if (!rules_.unwritten) return answer;
  std::string rest = rules_.unwritten();
  if (rest.empty()) return answer;
  return {State::waiting, asked_again(now), std::move(rest)};
}

FileCompletion::Time FileCompletion::asked_again(Time now) const {
  return now +
         std::chrono::duration_cast<Time::duration>(std::max<std::chrono::nanoseconds>(rules_.settle, kLeastPause));
}

CompletionAnswer FileCompletion::by_policy(const FileSample& sample, Time now) {
  if (!sample.exists) return {State::gone, {}, {}};
  if (seen_ != sample.identity) {
    seen_ = sample.identity;
    unchanged_since_ = now;
  }
  CompletionAnswer its_close{State::waiting, Time::max(), kHasWriter};
  switch (rules_.policy) {
    case Completion::close:
      if (writer_ == Writer::open) return its_close;
      if (writer_ == Writer::closed) return whole();
      if (rules_.has_writer && rules_.has_writer()) return {State::waiting, asked_again(now), kHasWriter};
      return when_unchanged(rules_.settle, now);
    case Completion::rename:
      return when_renamed(now);
    case Completion::marker:
      if (!sample.marked) return {State::waiting, Time::max(), cat("its marker *", rules_.marker, " is not there")};
      return when_unchanged(kCloseSettle, now);
    case Completion::size:
      if (rules_.store || rules_.unwritten) return when_unchanged(rules_.settle, now);  // the source is a directory
      if (!rules_.expected_bytes) {
        return {State::broken, {}, "its size cannot be known; name it NAME_XxYxZ_TYPE.raw or give dims and type"};
      }
      if (sample.identity.bytes < *rules_.expected_bytes) {
        if (writer_ == Writer::closed || writer_ == Writer::renamed) return when_unchanged(rules_.settle, now);
        return {State::waiting, now + rules_.settle,
                cat("it has ", sample.identity.bytes, " of ", *rules_.expected_bytes, " bytes")};
      }
      return when_unchanged(kCloseSettle, now);
    case Completion::stable:
      return when_unchanged(rules_.settle, now);
    case Completion::automatic:
      break;
  }
  switch (writer_) {
    case Writer::open:
      return its_close;
    case Writer::closed:
      return sample.identity.bytes == rules_.expected_bytes ? whole() : when_unchanged(kCloseSettle, now);
    case Writer::renamed:
      return whole();
    case Writer::unknown:
    case Writer::begun:
      break;
  }
  return when_unchanged(rules_.settle, now);
}

CompletionAnswer FileCompletion::when_renamed(Time now) {
  if (writer_ == Writer::renamed) return whole();
  const bool written = writer_ != Writer::unknown;
  if (written && !found_open_ && !named_) {
    return {State::waiting, Time::max(), "it has not got its name by a rename"};
  }
  // The file was there when the watch found it, or had its name before it was written to.
  if (rules_.has_writer && rules_.has_writer()) {
    found_open_ = true;
    return {State::waiting, asked_again(now), kHasWriter};
  }
  return when_unchanged(found_open_ || written ? rules_.settle : std::chrono::nanoseconds(0), now);
}

CompletionAnswer FileCompletion::when_unchanged(std::chrono::nanoseconds settle, Time now) const {
  const Time until = unchanged_since_ + std::chrono::duration_cast<Time::duration>(settle);
  const bool may_not_have_begun = seen_->bytes == 0 && writer_ != Writer::closed && writer_ != Writer::renamed;
  if (may_not_have_begun) return {State::waiting, Time::max(), "it is empty"};
  if (now >= until) return whole();
  return {State::waiting, until, "it changed a moment ago"};
}

CompletionAnswer FileCompletion::whole() const {
  if (seen_->bytes == 0) return {State::broken, {}, "is empty (0 bytes); write it again"};
  if (rules_.expected_bytes && seen_->bytes != *rules_.expected_bytes) {
    return {State::broken,
            {},
            cat("has ", seen_->bytes, " bytes and should have ", *rules_.expected_bytes,
                "; write it again, or correct its name or dims, type and offset")};
  }
  return {State::complete, {}, {}};
}

}  // namespace weir
