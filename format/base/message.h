// A message: one line for people that may name options. An option has a different name in each front end, --max-error
// on the command line and max_error in Python. So a message keeps the options apart from the text around them, and the
// front end that shows it chooses the words.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "format/base/text.h"

namespace weir {

/// An option, possibly with a value, inside a message.
struct OptionName {
  std::string key;    ///< as on the command line, without dashes: "max-error"
  std::string value;  ///< "keep" if the message says `--nonfinite keep`; empty: the option alone
};

/// Returns the option `key` as an argument of compose().
inline OptionName option(std::string_view key) { return {std::string(key), {}}; }
/// Returns the option `key` with `value`; a number is written as cat() writes it.
template <typename Value>
OptionName option(std::string_view key, const Value& value) {
  return {std::string(key), cat(value)};
}

/// How one front end writes an option: "--nonfinite keep", "nonfinite keep".
using OptionWording = std::string (*)(const OptionName& option);

/// Returns "--nonfinite keep"; the option "output" is "-o".
std::string command_line_wording(const OptionName& option);
/// Returns "max_error 2", for keys of a configuration and keywords of Python.
std::string key_wording(const OptionName& option);

/// A part of a message that only the command line shows, for instance a command to type, and the text that every other
/// front end shows instead.
struct CommandLineText {
  std::string command_line;
  std::string elsewhere;
};

class Message {
 public:
  Message() = default;
  Message(const char* text) : Message(std::string(text)) {}
  Message(std::string text);
  Message(OptionName option);
  Message(CommandLineText text);

  /// Returns the line in the words of a front end.
  std::string worded(OptionWording wording) const;
  /// Returns the line in the command line's words.
  std::string text() const { return worded(command_line_wording); }
  /// Returns the keys of the options that the message names, in their order.
  std::vector<std::string> option_keys() const;
  bool empty() const { return parts_.empty(); }
  /// Returns the message as bytes for another process, from which unpack() makes the message again. Texts hold no NUL.
  std::string packed() const;
  static Message unpack(std::string_view packed);
  /// Returns the same line as a remark: it tells how a request came out and is no warning.
  Message as_remark() const;
  bool is_remark() const { return remark_; }

  Message& operator+=(const Message& tail);

 private:
  std::vector<std::variant<std::string, OptionName, CommandLineText>> parts_;
  bool remark_ = false;
};

/// One argument of compose().
class MessagePiece {
 public:
  MessagePiece(const Message& message) : message_(message) {}
  MessagePiece(const OptionName& option) : message_(option) {}
  MessagePiece(const CommandLineText& text) : message_(text) {}
  template <typename Text>
  MessagePiece(const Text& text) : message_(cat(text)) {}

  const Message& message() const { return message_; }

 private:
  Message message_;
};

/// Receives lines that the user should know and that are not errors.
using Notice = std::function<void(const Message& line)>;

Message concatenate(std::initializer_list<MessagePiece> pieces);

/// Joins all arguments like cat(); they may also be options and messages.
template <typename... Args>
Message compose(const Args&... args) {
  return concatenate({MessagePiece(args)...});
}

}  // namespace weir
