#include <gtest/gtest.h>

#include "text/text.h"

namespace mssim {
namespace {

TEST(NoteTest, JoinsSentencesAndLeavesOutEmptyOnes) {
  std::string note;
  append_sentence(note, "");
  EXPECT_EQ(note, "");
  append_sentence(note, "one");
  append_sentence(note, "");
  EXPECT_EQ(note, "one");
  append_sentence(note, "another");
  EXPECT_EQ(note, "one; another");
}

}  // namespace
}  // namespace mssim
