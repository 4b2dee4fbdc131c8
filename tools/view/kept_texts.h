// Texts that are dear to make and asked for again by every viewer. Any thread may ask; two may make the same one.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace weir {

class KeptTexts {
 public:
  /// What was made for `key` before, or else `make()`, whose exceptions it passes on.
  std::string get(const std::string& key, const std::function<std::string()>& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = texts_.find(key);
      if (found != texts_.end()) return found->second;
    }
    std::string text = make();
    const std::lock_guard lock(mutex_);
    if (texts_.size() >= kMost) texts_.clear();
    texts_[key] = text;
    return text;
  }

 private:
  static constexpr std::size_t kMost = 512;

  std::mutex mutex_;
  std::map<std::string, std::string> texts_;
};

}  // namespace weir
