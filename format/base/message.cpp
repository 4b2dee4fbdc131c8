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

Message::Message(CommandLineText text) { parts_.emplace_back(std::move(text)); }

std::string Message::worded(OptionWording wording) const {
  std::string line;
  for (const auto& part : parts_) {
    if (const auto* const option = std::get_if<OptionName>(&part)) {
      line += wording(*option);
    } else if (const auto* const text = std::get_if<CommandLineText>(&part)) {
      line += wording == command_line_wording ? text->command_line : text->elsewhere;
    } else {
      line += std::get<std::string>(part);
    }
  }
  return line;
}

std::string Message::packed() const {
  std::string packed;
  const auto add = [&](char kind, const std::string& first, const std::string& second) {
    packed += cat(kind, first, '\0', second, '\0');
  };
  for (const auto& part : parts_) {
    if (const auto* const option = std::get_if<OptionName>(&part)) {
      add('o', option->key, option->value);
    } else if (const auto* const text = std::get_if<CommandLineText>(&part)) {
      add('c', text->command_line, text->elsewhere);
    } else {
      add('t', std::get<std::string>(part), {});
    }
  }
  return packed;
}

Message Message::unpack(std::string_view packed) {
  Message message;
  const auto next = [&] {
    const std::size_t end = packed.find('\0');
    const std::string text(packed.substr(0, end));
    packed.remove_prefix(std::min(packed.size(), text.size() + 1));
    return text;
  };
  while (!packed.empty()) {
    const char kind = packed.front();
    packed.remove_prefix(1);
    const std::string first = next();
    const std::string second = next();
    if (kind == 'o') {
      message += OptionName{first, second};
    } else if (kind == 'c') {
      message += CommandLineText{first, second};
    } else {
      message += first;
    }
  }
  return message;
}

std::vector<std::string> Message::option_keys() const {
  std::vector<std::string> keys;
  for (const auto& part : parts_) {
    if (const auto* const option = std::get_if<OptionName>(&part)) keys.push_back(option->key);
  }
  return keys;
}

Message Message::as_remark() const {
  Message remark = *this;
  remark.remark_ = true;
  return remark;
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
