#include "tools/view/volume_shelf.h"

#include <algorithm>
#include <utility>

#include "format/base/error.h"
#include "tools/view/base/file_identity.h"

namespace weir {

VolumeShelf::VolumeShelf(Backend& backend, std::size_t capacity)
    : backend_(backend), capacity_(std::max<std::size_t>(capacity, 1)) {
  if (capacity_ > 1) thread_ = std::thread([this] { fetch_ahead(); });
}

VolumeShelf::~VolumeShelf() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wanted_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<LoadedVolume> VolumeShelf::find(const std::string& identity) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.identity == identity; });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->volume;
}

bool VolumeShelf::has(const std::string& path) const {
  const std::string identity = file_identity(path);
  const std::lock_guard lock(mutex_);
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.identity == identity; });
}

std::shared_ptr<LoadedVolume> VolumeShelf::get(const std::string& path) {
  const std::string identity = file_identity(path);
  {
    const std::lock_guard lock(mutex_);
    if (auto volume = find(identity)) return volume;
  }
  return load(path, false);
}

bool VolumeShelf::clear() {
  const std::lock_guard lock(mutex_);
  const bool held = !entries_.empty();
  entries_.clear();
  return held;
}

// Loads a volume. The oldest volume is dropped first, because both might not fit into memory.
std::shared_ptr<LoadedVolume> VolumeShelf::load(const std::string& path, bool ahead) {
  const std::lock_guard one_at_a_time(loading_);
  const std::string identity = file_identity(path);  // before opening: a replacement has another identity
  {
    const std::lock_guard lock(mutex_);
    if (auto volume = find(identity)) return volume;  // loaded by another thread in the meantime
    entries_.remove_if([&](const Entry& e) { return e.path == path; });
    while (entries_.size() >= capacity_) entries_.pop_back();
  }
  const auto file = std::make_shared<const NvdbFile>(path);
  std::shared_ptr<LoadedVolume> volume;
  try {
    volume = backend_.load(file, 0, nullptr);
  } catch (const Error& error) {
    // No room, for instance in device memory. A volume loaded ahead must not displace one that is shown.
    if (ahead || error.kind() != ErrorKind::io || !clear()) throw;
    volume = backend_.load(file, 0, nullptr);
  }
  const std::lock_guard lock(mutex_);
  entries_.push_front({path, identity, volume});
  return volume;
}

void VolumeShelf::prefetch(const std::string& path) {
  if (!thread_.joinable() || has(path)) return;
  {
    const std::lock_guard lock(mutex_);
    wanted_ = path;
  }
  wanted_changed_.notify_all();
}

void VolumeShelf::fetch_ahead() {
  std::unique_lock lock(mutex_);
  while (!ended_) {
    wanted_changed_.wait(lock, [&] { return ended_ || !wanted_.empty(); });
    if (ended_) return;
    const std::string path = std::exchange(wanted_, {});
    lock.unlock();
    try {
      load(path, true);
    } catch (const std::exception&) {  // reported when the volume is shown
    }
    lock.lock();
  }
}

}  // namespace weir
