#include "tests/support/child_answer.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <exception>

namespace weir {

std::string answer_of_child(const std::function<std::string()>& measure) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return "no pipe";
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    std::string answer;
    try {
      answer = measure();
    } catch (const std::exception& error) {
      answer = error.what();
    }
    const ssize_t written = ::write(ends[1], answer.data(), answer.size());
    ::_exit(written == static_cast<ssize_t>(answer.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string answer(200, '\0');
  const ssize_t length = ::read(ends[0], answer.data(), answer.size());
  answer.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
  ::close(ends[0]);
  int status = -1;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  return answer;
}

}  // namespace weir
