#include "daemon/disks/output_disks.h"

#include <sys/stat.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "format/io/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

constexpr seconds kWindow{600};
constexpr seconds kInterval{3};
constexpr seconds kPatience{10};  ///< longer than a look usually takes
constexpr seconds kAsked{60};     ///< time without a request after which a directory is no longer looked at
constexpr double kYear_s = 365.0 * 24 * 3600;

// Returns the highest directory at or above `directory` on the same file system.
std::string mount_of(const std::string& directory, std::uint64_t device) {
  fs::path at = real_path(directory);
  std::string mount = at.string();
  for (;; at = at.parent_path()) {
    struct stat status {};
    if (::stat(at.c_str(), &status) == 0) {
      if (static_cast<std::uint64_t>(status.st_dev) != device) return mount;
      mount = at.string();
    }
    if (at == at.parent_path()) return mount;
  }
}

}  // namespace

// Shared with the thread, which may outlive the object if a file server hangs. While a look hangs, the thread looks
// at no other file system, and all figures stay as they were.
struct OutputDisks::Looker {
  struct Place {
    std::string directory;
    std::string mount;  ///< empty: not looked at yet
    DiskRoom room;
    std::optional<Time> begun;  ///< start of the look in progress
  };

  struct Asked {
    std::optional<DiskRoom> room;  ///< none: not looked at yet
    Time first;                    ///< time of the first request
    Time last;
  };

  explicit Looker(RoomIn room) : room_in(std::move(room)) {}

  const RoomIn room_in;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Place> places;
  std::map<std::string, Asked> asked;  ///< by directory
  bool again = true;
  bool asked_anew = false;
  bool over = false;

  void run() {
    std::unique_lock lock(mutex);
    while (!over) {
      again = false;
      for (std::size_t i = 0; i < places.size() && !over && !again; ++i) {
        const std::string directory = places[i].directory;
        places[i].begun = std::chrono::steady_clock::now();
        lock.unlock();
        const DiskRoom room = room_in(directory);
        std::string mount = mount_of(directory, room.device);
        lock.lock();
        if (again || over) break;  // watch() has replaced the places
        places[i].room = room;
        places[i].mount = std::move(mount);
        places[i].begun.reset();
      }
      look_at_asked(lock);
      changed.wait_for(lock, kInterval, [&] { return over || again || asked_anew; });
    }
  }

  void look_at_asked(std::unique_lock<std::mutex>& lock) {
    asked_anew = false;
    std::erase_if(asked, [now = std::chrono::steady_clock::now()](const auto& entry) {
      return now - entry.second.last > kAsked;
    });
    std::vector<std::string> directories;
    for (const auto& [directory, entry] : asked) directories.push_back(directory);
    for (const std::string& directory : directories) {
      if (over || again) return;
      const Time begun = std::chrono::steady_clock::now();
      lock.unlock();
      const DiskRoom room = room_in(directory);
      lock.lock();
      if (const auto at = asked.find(directory); at != asked.end() && at->second.first <= begun) at->second.room = room;
    }
  }
};

OutputDisks::OutputDisks(RoomIn room_in) : looker_(std::make_shared<Looker>(std::move(room_in))) {
  std::thread([looker = looker_] { looker->run(); }).detach();
}

OutputDisks::~OutputDisks() {
  const std::lock_guard lock(looker_->mutex);
  looker_->over = true;
  looker_->changed.notify_all();
}

void OutputDisks::watch(const std::vector<std::string>& directories) {
  const std::lock_guard lock(looker_->mutex);
  const std::vector<Looker::Place> before = std::exchange(looker_->places, {});
  for (const std::string& directory : directories) {
    const auto known = std::find_if(before.begin(), before.end(),
                                    [&](const Looker::Place& place) { return place.directory == directory; });
    looker_->places.push_back(known == before.end() ? Looker::Place{directory, "", {}, {}} : *known);
  }
  looker_->again = true;
  looker_->changed.notify_all();
}

void OutputDisks::written(const std::string& directory, std::uint64_t bytes, Time now) {
  const std::lock_guard lock(looker_->mutex);
  const auto& places = looker_->places;
  const auto at = std::find_if(places.begin(), places.end(),
                               [&](const Looker::Place& place) { return lies_below(directory, place.directory); });
  if (at == places.end() || at->mount.empty()) return;
  rates_.try_emplace(at->room.device, kWindow, start_).first->second.add(bytes, now);
}

std::optional<DiskRoom> OutputDisks::room(const std::string& directory) const {
  const std::lock_guard lock(looker_->mutex);
  const Time now = std::chrono::steady_clock::now();
  const auto [at, is_new] = looker_->asked.try_emplace(directory, Looker::Asked{{}, now, now});
  at->second.last = now;
  if (is_new) {
    looker_->asked_anew = true;
    looker_->changed.notify_all();
  }
  return at->second.room;
}

void OutputDisks::look_anew(const std::string& directory) {
  const std::lock_guard lock(looker_->mutex);
  looker_->asked.erase(directory);
}

std::vector<OutputDisk> OutputDisks::disks(Time now) const {
  std::vector<OutputDisk> disks;
  const std::lock_guard lock(looker_->mutex);
  for (const Looker::Place& place : looker_->places) {
    if (place.mount.empty()) continue;
    const auto known = std::find_if(disks.begin(), disks.end(),
                                    [&](const OutputDisk& disk) { return disk.room.device == place.room.device; });
    const auto waited = place.begun ? std::chrono::duration_cast<seconds>(now - *place.begun) : seconds(0);
    const seconds silent = waited > kPatience ? waited : seconds(0);
    if (known != disks.end()) {
      known->silent = std::max(known->silent, silent);
      if (std::find(known->directories.begin(), known->directories.end(), place.directory) ==
          known->directories.end()) {
        known->directories.push_back(place.directory);
      }
      continue;
    }
    OutputDisk& disk = disks.emplace_back(OutputDisk{place.mount, {place.directory}, place.room, 0, {}, silent});
    if (const auto rate = rates_.find(place.room.device); rate != rates_.end()) {
      disk.written_bytes_per_s = rate->second.at(now).bytes_per_s;
    }
    const double fills_in_s = static_cast<double>(place.room.free) / disk.written_bytes_per_s;
    if (fills_in_s < kYear_s) disk.fills_in_s = fills_in_s;
  }
  return disks;
}

}  // namespace weir
