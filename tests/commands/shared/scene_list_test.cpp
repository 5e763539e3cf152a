#include "commands/shared/scene_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ScenesIn, AreSeparatedByCommas) {
  EXPECT_THAT(names_and_files_in("cloth2500"), ElementsAre("cloth2500"));
  EXPECT_THAT(names_and_files_in("cloth2500,x.json,torus-small"),
              ElementsAre("cloth2500", "x.json", "torus-small"));
  EXPECT_THAT(names_and_files_in("cloth2500,,torus-small,"), ElementsAre("cloth2500", "torus-small"));
  EXPECT_THAT(names_and_files_in(""), IsEmpty());
  EXPECT_THAT(names_and_files_in(","), IsEmpty());
}

class ScenesInFolder : public TemporaryFolderTest {};

TEST_F(ScenesInFolder, AreNotCutWithinThePathOfAFile) {
  const std::string comma = put("a,b.json", "{}").string();
  const std::string plain = put("c.json", "{}").string();
  EXPECT_THAT(names_and_files_in(comma), ElementsAre(comma));
  EXPECT_THAT(names_and_files_in("cloth2500," + comma + "," + plain), ElementsAre("cloth2500", comma, plain));
  EXPECT_THAT(names_and_files_in(plain + "," + comma), ElementsAre(plain, comma));
  EXPECT_THAT(names_and_files_in(comma + "x"), ElementsAre((folder() / "a").string(), "b.jsonx"));
}

}  // namespace
}  // namespace mssim
