// Caches texts that are expensive to make and that every viewer asks for. Any thread may ask; two threads may make the
// same text.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace weir {

class KeptTexts {
 public:
  /// Returns the text kept for `key`, otherwise the result of `make()`, whose exceptions pass through.
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
