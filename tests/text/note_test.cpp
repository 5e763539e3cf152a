#include "text/note.h"

#include <gtest/gtest.h>

namespace mssim {
namespace {

TEST(NoteTest, JoinsSentencesAndLeavesOutEmptyOnes) {
  std::string note;
  add_to_note(note, "");
  EXPECT_EQ(note, "");
  add_to_note(note, "one");
  add_to_note(note, "");
  EXPECT_EQ(note, "one");
  add_to_note(note, "another");
  EXPECT_EQ(note, "one; another");
}

}  // namespace
}  // namespace mssim
