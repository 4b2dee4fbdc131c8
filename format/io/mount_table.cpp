#include "format/io/mount_table.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "format/io/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

// Spaces, tabs, line ends and backslashes stand as three octal digits behind a backslash.
std::string unescaped(const std::string& text) {
  const auto digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '7'; };
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && digit(i + 1) && digit(i + 2) && digit(i + 3)) {
      plain += static_cast<char>((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8 + (text[i + 3] - '0'));
      i += 3;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

// Without "." and "..", and without a slash at the end unless it is the root.
std::string normal(const std::string& path) {
  const std::string text = fs::path(path).lexically_normal().string();
  return text.size() > 1 && text.ends_with('/') ? text.substr(0, text.size() - 1) : text;
}

}  // namespace

MountTable MountTable::read() {
  std::ifstream file("/proc/self/mountinfo");
  return MountTable(std::string(std::istreambuf_iterator<char>(file), {}));
}

MountTable::MountTable(std::string_view lines) {
  std::istringstream text{std::string(lines)};
  for (std::string line; std::getline(text, line);) {
    std::istringstream fields(line);
    Mount mount;
    if (!(fields >> mount.id >> mount.parent >> mount.device >> mount.root >> mount.point)) continue;
    for (std::string field; fields >> field && field != "-";) {
    }
    if (!(fields >> mount.type)) continue;
    mount.root = unescaped(mount.root);
    mount.point = unescaped(mount.point);
    mounts_.push_back(std::move(mount));
  }
}

const MountTable::Mount* MountTable::find(int id) const {
  const auto at = std::ranges::find(mounts_, id, &Mount::id);
  return at == mounts_.end() ? nullptr : &*at;
}

// Goes down the path as the kernel does, so that a mount that another one hides is not found.
const MountTable::Mount* MountTable::topmost_at(const std::string& point) const {
  const auto is_root = [this](const Mount& mount) {
    return mount.point == "/" && (mount.parent == mount.id || find(mount.parent) == nullptr);
  };
  const auto root = std::ranges::find_if(mounts_, is_root);
  if (root == mounts_.end()) return nullptr;
  const Mount* at = &*root;
  const auto enter_mounts_at = [&](const std::string& directory) {
    const Mount* above = nullptr;
    while (std::exchange(above, at) != at) {
      const auto covers = [&](const Mount& mount) { return mount.parent == at->id && mount.point == directory; };
      const auto next = std::ranges::find_if(mounts_, covers);
      if (next != mounts_.end()) at = &*next;
    }
  };
  enter_mounts_at("/");
  for (std::size_t end = point.find('/', 1); point != "/"; end = point.find('/', end + 1)) {
    enter_mounts_at(point.substr(0, end));
    if (end == std::string::npos) break;
  }
  return at->point == point ? at : nullptr;
}

bool MountTable::shows_what_it_covers(const Mount& mount) const {
  const Mount* const parent = find(mount.parent);
  if (parent == nullptr || parent == &mount || parent->device != mount.device) return false;
  const fs::path below = fs::path(mount.point).lexically_relative(parent->point);
  return normal((fs::path(parent->root) / below).string()) == mount.root;
}

bool MountTable::mounted(const std::string& path) const {
  std::string point = normal(path);
  const Mount* mount = topmost_at(point);
  if (mount == nullptr) {
    point = real_path(path).string();
    mount = topmost_at(point);
  }
  while (mount != nullptr && (mount->type == "autofs" || shows_what_it_covers(*mount))) {
    const Mount* const parent = find(mount->parent);
    mount = parent != nullptr && parent != mount && parent->point == point ? parent : nullptr;
  }
  return mount != nullptr;
}

bool is_mounted(const std::string& path) { return path.empty() || MountTable::read().mounted(path); }

}  // namespace weir
