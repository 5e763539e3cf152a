#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "output/tables/suite_tables.h"
#include "output/tables/table.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(PublishedBodies, AreNineWhoseSpringsCanBeDividedByThree) {
  const std::vector<PublishedBody> bodies = published_bodies();
  EXPECT_EQ(bodies.size(), 9U);
  for (const PublishedBody& body : bodies) EXPECT_EQ(body.springs % 3, 0U) << body.scene();
  EXPECT_EQ(bodies.front().scene(), "box-small");
  EXPECT_EQ(bodies.front().springs, 12921U);
}

const std::vector<StructureRow> structure_rows{{"box-small", 700, 4307, 12921, 3256, 4.25},
                                               {"torus-large", 1977, 13012, 39036, 10000, 1.5},
                                               {"torus-small", 621, 3690, 11070, 2000, 2},
                                               {"my-own", 4, 6, 18, 1, 70.5}};

TEST(StructureTable, AsCsvHasOurMeshesBesideThePublishedOnes) {
  EXPECT_EQ(table_csv(structure_table(structure_rows, {}).data),
            "scene,nodes,springs_unique,springs_published,tetrahedra,smallest_dihedral_angle_deg,paper_nodes,"
            "paper_springs,same_as_paper\n"
            "box-small,700,4307,12921,3256,4.25,700,12921,true\n"
            "torus-large,1977,13012,39036,10000,1.5,1977,39033,false\n"
            "torus-small,621,3690,11070,2000,2,620,11070,false\n"
            "my-own,4,6,18,1,70.5,,,\n");
}

TEST(StructureTable, AsMarkdownShowsOnlyThePapersBodiesAndSaysWhichDiffer) {
  const std::string page = markdown(structure_table(structure_rows, {}).page);
  EXPECT_THAT(
      page, HasSubstr("| box | small | 700 | **700** | 12,921 | **12,921** | 4,307 | 3,256 | 4.25° | yes |"));
  EXPECT_THAT(
      page,
      HasSubstr(
          "| torus | large | 1,977 | **1,977** | 39,033 | **39,036** | 13,012 | 10,000 | 1.50° | **no** |"));
  EXPECT_THAT(page, HasSubstr("three times the unique edges, by inference"));
  EXPECT_THAT(page, Not(HasSubstr("my-own")));
}

}  // namespace
}  // namespace mssim
