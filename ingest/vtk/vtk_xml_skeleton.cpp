#include "ingest/vtk/vtk_xml_skeleton.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {

bool VtkXmlSkeleton::push(std::string_view bytes) {
  while (!bytes.empty() && state_ != State::ended) {
    if (state_ == State::text) {
      // Text may be long and is not examined: skips to the next tag at once.
      const std::size_t length = std::min(bytes.find('<'), bytes.size());
      for (std::size_t i = 0; i < length && !has_text_; ++i) has_text_ = !is_space(bytes[i]);
      position_ += length;
      bytes.remove_prefix(length);
      if (bytes.empty()) break;
    }
    take(bytes.front());
    bytes.remove_prefix(1);
    ++position_;
  }
  return state_ != State::ended;
}

void VtkXmlSkeleton::take(char c) {
  switch (state_) {
    case State::text:  // c is '<'
      if (has_text_) xml_ += cat(text_begin_, ' ', position_);
      tag_ = c;
      state_ = State::tag;
      return;
    case State::tag:
      tag_ += c;
      if (tag_ == "<!--") {
        state_ = State::comment;
      } else if (tag_.size() >= 4 && tag_[1] == '!') {
        fail("a declaration begins");
      } else if (c == '"' || c == '\'') {
        quote_ = c;
        state_ = State::quoted;
      } else if (c == '>') {
        end_tag();
      }
      break;
    case State::quoted:
      tag_ += c;
      if (c == quote_) state_ = State::tag;
      break;
    case State::comment:
      // If the two characters before this one are "--", the comment ends here.
      if (c == '>' && tag_.ends_with("--")) {
        tag_.clear();
        end_tag();
        return;
      }
      tag_ = {tag_.back(), c};
      return;
    case State::before_appended:
      if (c == '_') {
        appended_ = position_ + 1;
        state_ = State::ended;
      } else if (!is_space(c)) {
        fail("appended data begin with another character than '_'");
      }
      return;
    case State::ended:
      return;
  }
  if (xml_.size() + tag_.size() > kMaxBytes) fail(cat("its markup is longer than ", kMaxBytes, " bytes"));
}

void VtkXmlSkeleton::end_tag() {
  xml_ += tag_;
  state_ = State::text;
  has_text_ = false;
  text_begin_ = position_ + 1;
  const bool closes_itself = tag_.ends_with("/>") || tag_.starts_with("<?") || tag_.empty();
  if (tag_.starts_with("</")) {
    --depth_;
  } else if (!closes_itself && ++depth_ > kMaxDepth) {
    fail(cat("its elements are nested deeper than ", kMaxDepth));
  }
  if (!closes_itself && (tag_.starts_with("<AppendedData ") || tag_ == "<AppendedData>")) {
    state_ = State::before_appended;
  }
}

std::string VtkXmlSkeleton::xml() const {
  const bool open = state_ == State::ended || state_ == State::before_appended;
  return open ? xml_ + "</AppendedData></VTKFile>" : xml_;
}

void VtkXmlSkeleton::fail(std::string_view what) const {
  throw Error(ErrorKind::input, cat(path_, ": at byte ", position_, ": ", what, "; this is no VTK image file"));
}

}  // namespace weir
