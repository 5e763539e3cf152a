#include <set>

#include "output/pictures/painter.h"
#include "platform/files.h"
#include "tests/support/cloth_system.h"
#include "tests/support/png_fixture.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

const PictureOptions small{{35, 18}, 160, 120, ColourBy::object, 2};

class PicturesOfARun : public TemporaryFolderTest {
 protected:
  const System system_ = cloth_system(12, 15);
  PictureFolder pictures_in(const std::filesystem::path& name) const {
    return {name, trace_content_of(system_, {}, {}), small};
  }
  static std::set<std::string> names_in(const std::filesystem::path& name) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(name))
      names.insert(entry.path().filename().string());
    return names;
  }
};

TEST_F(PicturesOfARun, AreWhatAPainterDrawsOfAllSoFar) {
  const std::filesystem::path name = folder() / "new" / "pictures";
  const std::vector<Vec3d>& start = system_.start.position;
  std::vector<Vec3d> far = start;
  for (Vec3d& position : far) position += Vec3d{2, -0.5, 1};
  const TraceContent content = trace_content_of(system_, {}, {});
  Painter painter(content, start, small);
  {
    PictureFolder pictures = pictures_in(name);
    pictures.draw(start);
    pictures.draw(far);
    pictures.draw(start);
    EXPECT_EQ(pictures.pictures(), 3U);
  }
  EXPECT_EQ(names_in(name),
            (std::set<std::string>{"frame-000000.png", "frame-000001.png", "frame-000002.png"}));
  painter.make_room_for(start);
  EXPECT_EQ(decoded(text_of(name / "frame-000000.png")), painter.picture_of(start));
  painter.make_room_for(far);
  EXPECT_EQ(decoded(text_of(name / "frame-000001.png")), painter.picture_of(far));
  EXPECT_EQ(decoded(text_of(name / "frame-000002.png")), painter.picture_of(start));
}

TEST_F(PicturesOfARun, NeedAFolderOfTheirOwn) {
  put("used/notes.txt", "mine");
  put("file", "no folder");
  EXPECT_THROW(pictures_in(folder() / "used"), WriteError);
  EXPECT_THROW(pictures_in(folder() / "file"), WriteError);
  EXPECT_EQ(names_in(folder() / "used"), std::set<std::string>{"notes.txt"});
  const PictureFolder first = pictures_in(folder() / "pictures");
  EXPECT_THROW(pictures_in(folder() / "pictures"), WriteError);
}

}  // namespace
}  // namespace mssim
