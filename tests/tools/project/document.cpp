#include "tests/tools/project/document.h"

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "format/base/text.h"

namespace weir::test {

namespace {

bool starts(const std::string& line, std::string_view with) { return line.rfind(with, 0) == 0; }

[[noreturn]] void fail(int line, const std::string& what) { throw std::runtime_error(cat("line ", line, ": ", what)); }

class Parser {
 public:
  explicit Parser(std::string_view text) : stream_(std::string(text)) {}

  Document parse() {
    while (next()) {
      if (starts(line_, "<!-- ")) {
        mark();
      } else if (starts(line_, "```")) {
        fence();
      } else if (!line_.empty()) {
        if (marked_) fail(number_, "a mark stands before no block of commands");
        behind_failure_ = false;
        add_links();
      }
    }
    if (marked_) fail(number_, "a mark stands before no block of commands");
    return std::move(document_);
  }

 private:
  bool next() {
    ++number_;
    return static_cast<bool>(std::getline(stream_, line_));
  }

  // Reads a mark "<!-- NAME: TEXT -->" of one or more lines.
  void mark() {
    const int first = number_;
    std::string text = line_.substr(5);
    while (text.find("-->") == std::string::npos) {
      if (!next()) fail(first, "a comment without an end");
      text += cat('\n', line_);
    }
    text.resize(text.find("-->"));
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    const std::string value = colon == std::string::npos ? "" : trimmed(text.substr(colon + 1));
    if (value.empty()) fail(first, cat("\"", trimmed(text), "\" is no mark: NAME: TEXT"));
    if (name == "before") {
      block_.before = value;
    } else if (name == "fails") {
      block_.exit_code = std::stoi(value);
    } else if (name == "not run") {
      block_.not_run = value;
    } else {
      fail(first, cat("no mark is called \"", name, "\""));
    }
    marked_ = true;
  }

  void fence() {
    const std::string language = line_.substr(3);
    const int first = number_ + 1;
    std::string content;
    while (next() && line_ != "```") content += cat(line_, '\n');
    if (language == "sh") {
      block_.line = first;
      block_.commands = content;
      behind_failure_ = block_.exit_code != 0;
      document_.blocks.push_back(std::move(block_));
      block_ = {};
      marked_ = false;
    } else if (language == "text" && behind_failure_) {
      document_.blocks.back().message = content;
      behind_failure_ = false;
    }
  }

  void add_links() {
    static const std::regex link(R"(\]\(([^)#:]+)(#[^)]*)?\))");
    for (std::sregex_iterator i(line_.begin(), line_.end(), link), end; i != end; ++i) {
      const std::string path = (*i)[1];
      if (std::ranges::find(document_.links, path) == document_.links.end()) document_.links.push_back(path);
    }
  }

  static std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \n");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \n") - first + 1);
  }

  std::istringstream stream_;
  std::string line_;
  int number_ = 0;
  CommandBlock block_;  ///< marks of the next block
  bool marked_ = false;
  bool behind_failure_ = false;
  Document document_;
};

}  // namespace

Document parse_document(std::string_view text) { return Parser(text).parse(); }

}  // namespace weir::test
