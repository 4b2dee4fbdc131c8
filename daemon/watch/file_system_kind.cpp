#include "daemon/watch/file_system_kind.h"

#include <sys/vfs.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ios>
#include <string_view>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

struct Known {
  std::uint64_t type;
  std::string_view name;
  bool local;
};

// Sources of the numbers: statfs(2) and linux/magic.h; for Lustre, GPFS, BeeGFS, ZFS and bcachefs, their own sources.
constexpr std::array kKnown{
    Known{0xEF53, "ext4", true},         Known{0x58465342, "xfs", true},
    Known{0x9123683E, "btrfs", true},    Known{0x2FC12FC1, "zfs", true},
    Known{0xCA451A4E, "bcachefs", true}, Known{0xF2F52010, "f2fs", true},
    Known{0x01021994, "tmpfs", true},    Known{0x858458F6, "ramfs", true},
    Known{0x794C7630, "overlay", true},  Known{0x3153464A, "jfs", true},
    Known{0x52654973, "reiserfs", true}, Known{0x4D44, "vfat", true},
    Known{0x2011BAB0, "exfat", true},    Known{0x7366746E, "ntfs3", true},
    Known{0x6969, "nfs", false},         Known{0xFF534D42, "cifs", false},
    Known{0xFE534D42, "smb2", false},    Known{0x0BD00BD0, "lustre", false},
    Known{0x47504653, "gpfs", false},    Known{0x65735546, "fuse", false},
    Known{0x01021997, "9p", false},      Known{0x00C36400, "ceph", false},
    Known{0x19830326, "beegfs", false},  Known{0x20030528, "orangefs", false},
    Known{0x5346414F, "afs", false},     Known{0x6B414653, "afs", false},
    Known{0x01161970, "gfs2", false},  // on a disk that other machines write to as well
    Known{0x7461636F, "ocfs2", false},
};

}  // namespace

FileSystemKind file_system_kind(std::uint64_t statfs_type) {
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.type == statfs_type; });
  if (known == kKnown.end()) {
    return {"type 0x" + upper_case(hex(statfs_type)), false};
  }
  return {std::string(known->name), known->local};
}

FileSystemKind file_system_kind(const struct statfs& status) {
  // f_type is signed, and some type numbers are above 2^31.
  return file_system_kind(std::uint64_t{static_cast<std::uint32_t>(status.f_type)});
}

FileSystemKind file_system_kind(const std::string& path) {
  struct statfs status {};
  if (::statfs(path.c_str(), &status) != 0) throw io_error(path, "ask for its file system", errno);
  return file_system_kind(status);
}

}  // namespace weir
