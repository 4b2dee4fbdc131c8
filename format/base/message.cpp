#include "format/base/message.h"

#include <algorithm>
#include <utility>

namespace weir {
namespace {

std::string with_value(std::string name, const OptionName& option) {
  return option.value.empty() ? name : cat(name, " ", option.value);
}

}  // namespace

std::string command_line_wording(const OptionName& option) {
  return with_value(option.key == "output" ? "-o" : "--" + option.key, option);
}

std::string key_wording(const OptionName& option) {
  std::string key = option.key;
  std::replace(key.begin(), key.end(), '-', '_');
  return with_value(std::move(key), option);
}

Message::Message(std::string text) {
  if (!text.empty()) parts_.emplace_back(std::move(text));
}

Message::Message(OptionName option) { parts_.emplace_back(std::move(option)); }

std::string Message::worded(OptionWording wording) const {
  std::string line;
  for (const auto& part : parts_) {
    const auto* const option = std::get_if<OptionName>(&part);
    line += option != nullptr ? wording(*option) : std::get<std::string>(part);
  }
  return line;
}

std::vector<std::string> Message::option_keys() const {
  std::vector<std::string> keys;
  for (const auto& part : parts_) {
    if (const auto* const option = std::get_if<OptionName>(&part)) keys.push_back(option->key);
  }
  return keys;
}

Message& Message::operator+=(const Message& tail) {
  parts_.insert(parts_.end(), tail.parts_.begin(), tail.parts_.end());
  return *this;
}

Message concatenate(std::initializer_list<MessagePiece> pieces) {
  Message message;
  for (const MessagePiece& piece : pieces) message += piece.message();
  return message;
}

}  // namespace weir
