// One line for people that may name options. An option has another name wherever it can be set, --max-error on the
// command line and max_error in Python, so a message keeps the options apart from the text around them, and whoever
// shows it chooses the words.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "format/base/text.h"

namespace weir {

/// An option, and perhaps a value of it, inside a message.
struct OptionName {
  std::string key;    ///< as on the command line, without dashes: "max-error"
  std::string value;  ///< "keep" where the message says `--nonfinite keep`; empty: the option alone
};

/// The option `key` as an argument of compose().
inline OptionName option(std::string_view key) { return {std::string(key), {}}; }
/// The option with this value; a number as cat() writes it.
template <typename Value>
OptionName option(std::string_view key, const Value& value) {
  return {std::string(key), cat(value)};
}

/// How one front end writes an option: "--nonfinite keep", "nonfinite keep".
using OptionWording = std::string (*)(const OptionName& option);

/// "--nonfinite keep"; the output is "-o".
std::string command_line_wording(const OptionName& option);
/// "max_error 2": a key of a configuration, a keyword of Python.
std::string key_wording(const OptionName& option);

/// A part of a message that a command line shows, a command to type for instance, and what every other front end shows
/// in its place.
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

  /// One line in the words of a front end.
  std::string worded(OptionWording wording) const;
  /// In the command line's words.
  std::string text() const { return worded(command_line_wording); }
  /// Keys of the options named, in their order.
  std::vector<std::string> option_keys() const;
  bool empty() const { return parts_.empty(); }
  /// As bytes for another process, which unpack() makes the message of again. Texts hold no NUL.
  std::string packed() const;
  static Message unpack(std::string_view packed);
  /// The same line as one that tells how what was asked for came out, and warns of nothing.
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

/// Takes what the user should know and is no error.
using Notice = std::function<void(const Message& line)>;

Message concatenate(std::initializer_list<MessagePiece> pieces);

/// All arguments one after the other, as cat(), which may be options and messages too.
template <typename... Args>
Message compose(const Args&... args) {
  return concatenate({MessagePiece(args)...});
}

}  // namespace weir
