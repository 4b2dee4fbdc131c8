#include "ingest/hdf5/file/hdf5_walk.h"

#include <array>
#include <deque>
#include <new>
#include <set>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

struct Link {
  std::string name;
  H5L_type_t type;
};

struct Links {
  std::vector<Link> found;
  bool no_memory = false;  ///< for all of them; an exception must not pass through the library
};

herr_t collect_link(hid_t /*group*/, const char* name, const H5L_info_t* info, void* all) {
  auto& links = *static_cast<Links*>(all);
  try {
    if (info->type == H5L_TYPE_HARD || info->type == H5L_TYPE_SOFT || info->type == H5L_TYPE_EXTERNAL) {
      links.found.push_back({name, info->type});
    }
  } catch (const std::bad_alloc&) {
    links.no_memory = true;
    return -1;
  }
  return 0;
}

struct Group {
  std::string name;
  Hdf5Handle handle;
  int depth = 0;  ///< 0: the group that the walk begins at
};

Error too_deep(const Group& group) {
  return input_error(file_of(group.handle.get()),
                     compose("groups are nested more than ", kMaxGroupDepth, " deep in ", in_quotes(group.name),
                             "; name a dataset with ", option("dataset")));
}

class GroupWalk {
 public:
  using Visit = std::function<void(std::string, Hdf5Handle)>;
  using Unread = std::function<void(const UnreadObject&)>;
  GroupWalk(const Visit& visit, const Unread& unread) : visit_(visit), unread_(unread) {}

  void run(hid_t file, const std::string& name) {
    Hdf5Handle root(H5Oopen(file, name.c_str(), H5P_DEFAULT));
    if (!root) return say_damaged(name, "cannot be opened");
    if (!is_new(name, root.get())) return;
    groups_.push_back({name == "/" ? "" : name, std::move(root), 0});
    // External links wait until everything in the file itself has its name.
    while (!groups_.empty() || !external_.empty()) {
      if (groups_.empty()) {
        const std::string link = std::move(external_.front());
        external_.pop_front();
        Hdf5Handle object(H5Oopen(file, link.c_str(), H5P_DEFAULT));
        if (!object) {
          unread_({link, cat("leads to another file, and cannot be followed: ", hdf5_reason()), true});
          continue;
        }
        // The file stays open, because a reopened file gets another number. Known objects in it would then look new.
        kept_.emplace_back(H5Iget_file_id(object.get()));
        take(link, std::move(object), 1);
      } else {
        const Group group = std::move(groups_.front());
        groups_.pop_front();
        enter(group);
      }
    }
  }

 private:
  // Reports a damaged object. Call it right after the library call that failed.
  void say_damaged(const std::string& name, const char* what) {
    unread_({name, cat(what, ": ", hdf5_reason(), "; the file is damaged")});
  }

  bool is_new(const std::string& path, hid_t object) {
    H5O_info_t info;
    if (H5Oget_info2(object, &info, H5O_INFO_BASIC) >= 0) return seen_.emplace(info.fileno, info.addr).second;
    say_damaged(path, "cannot be opened");
    return false;
  }

  void enter(const Group& group) {
    if (group.depth > kMaxGroupDepth) throw too_deep(group);
    Links links;
    if (H5Literate(group.handle.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_link, &links) < 0) {
      if (links.no_memory) throw std::bad_alloc();
      say_damaged(group.name.empty() ? "/" : group.name, "what it holds cannot be listed");
    }
    for (const Link& link : links.found) {
      std::string path = group.name + '/' + link.name;
      if (link.type == H5L_TYPE_SOFT) {
        look_at_soft(group, link.name, path);
      } else if (link.type == H5L_TYPE_HARD) {
        Hdf5Handle object(H5Oopen(group.handle.get(), link.name.c_str(), H5P_DEFAULT));
        if (!object) {
          say_damaged(path, "cannot be opened");
          continue;
        }
        take(path, std::move(object), group.depth + 1);
      } else if (followed_ < kMaxExternalLinks) {
        ++followed_;
        external_.push_back(std::move(path));
      } else if (followed_++ == kMaxExternalLinks) {
        unread_({path, cat("is a link to another file, and ", kMaxExternalLinks, " of these are followed")});
      }
    }
  }

  // Reports a soft link that leads nowhere. A target that exists is found by its own name.
  void look_at_soft(const Group& group, const std::string& name, const std::string& path) {
    if (H5Oexists_by_name(group.handle.get(), name.c_str(), H5P_DEFAULT) > 0) return;
    std::array<char, 4096> target{};
    H5Lget_val(group.handle.get(), name.c_str(), target.data(), target.size() - 1, H5P_DEFAULT);
    unread_({path, cat("is a soft link to ", target.data(), ", which is not there"), true});
  }

  void take(const std::string& path, Hdf5Handle object, int depth) {
    if (!is_new(path, object.get())) return;
    if (is_dataset(object.get()) || is_openpmd_constant(object.get())) {
      visit_(path, std::move(object));
    } else if (H5Iget_type(object.get()) == H5I_GROUP) {
      groups_.push_back({path, std::move(object), depth});
    }
  }

  const Visit& visit_;
  const Unread& unread_;
  std::set<std::pair<unsigned long, haddr_t>> seen_;
  std::deque<Group> groups_;
  std::deque<std::string> external_;
  std::size_t followed_ = 0;
  std::vector<Hdf5Handle> kept_;
};

}  // namespace

void walk_datasets(hid_t file, const std::string& name,
                   const std::function<void(std::string name, Hdf5Handle object)>& visit,
                   const std::function<void(const UnreadObject&)>& unread) {
  GroupWalk(visit, unread).run(file, name);
}

}  // namespace weir
