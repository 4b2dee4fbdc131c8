#include "daemon/watch/repeated_events.h"

#include <gtest/gtest.h>

#include <string>

namespace weir::repeated_events_test {
namespace {

std::string text_of(const std::deque<FileEvent>& events) {
  std::string text;
  for (const FileEvent& event : events) {
    text += event.kind == FileEventKind::found ? 'f' : event.kind == FileEventKind::written ? 'w' : 'c';
    text += event.path + ' ';
  }
  return text;
}

TEST(RepeatedEvents, LeaveTheLastOfEachKindAndFile_InTheirOrder) {
  using enum FileEventKind;
  std::deque<FileEvent> events{{found, "a"},  {found, "b"},   {written, "a"}, {written, "a"}, {written, "b"},
                               {closed, "b"}, {written, "a"}, {closed, "a"},  {written, "b"}, {written, "a"}};
  EXPECT_EQ(drop_repeated_events(events, 2), 2U);
  EXPECT_EQ(text_of(events), "fa fb cb ca wb wa ");
  EXPECT_EQ(drop_repeated_events(events, 2), 2U);
  EXPECT_EQ(text_of(events), "fa fb cb ca wb wa ");
}

TEST(RepeatedEvents, OfTheFirstLookAreNoMoreAmongItsEvents_WhereTheyCameAgain) {
  using enum FileEventKind;
  std::deque<FileEvent> events{{found, "a"}, {found, "b"}, {found, "a"}};
  EXPECT_EQ(drop_repeated_events(events, 2), 1U);
  EXPECT_EQ(text_of(events), "fb fa ");
}

}  // namespace
}  // namespace weir::repeated_events_test
