#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "statistics/statistics.h"

namespace mssim {
namespace {

// The example of the NIST/SEMATECH e-Handbook of Statistical Methods, section 7.1.6.
const std::vector<double> nist{30,  171, 184, 201, 212, 250, 265, 270, 272, 289, 305, 306,  322,  322,  336,
                               346, 351, 370, 390, 404, 409, 411, 436, 437, 439, 441, 444,  448,  451,  453,
                               470, 480, 482, 487, 494, 495, 499, 503, 514, 521, 522, 527,  548,  550,  559,
                               560, 570, 572, 574, 578, 585, 592, 592, 607, 616, 618, 621,  629,  637,  638,
                               640, 656, 668, 707, 709, 719, 737, 739, 752, 758, 766, 792,  792,  794,  802,
                               818, 830, 832, 843, 858, 860, 869, 918, 925, 953, 991, 1000, 1005, 1068, 1441};

TEST(Outliers, AreThoseOfAPublishedExample) {
  const Quartiles found = quartiles(nist);
  EXPECT_DOUBLE_EQ(found.first, 429.75);
  EXPECT_DOUBLE_EQ(found.third, 742.25);
  const std::vector<Outlier> labels = outliers(nist);
  EXPECT_EQ(labels.back(), Outlier::mild);  // beyond 1211, the upper inner fence
  EXPECT_EQ(std::ranges::count(labels, Outlier::no), 89);
}

TEST(Outliers, AreExtremeBeyondTheOuterFenceAndLabelledWhereTheyStand) {
  std::vector<double> samples = nist;
  samples.front() = 1679.5;  // the quartiles move a little: 30 was below both
  samples[1] = 5000;
  samples.push_back(-5000);
  const std::vector<Outlier> labels = outliers(samples);
  EXPECT_EQ(labels[0], Outlier::mild);
  EXPECT_EQ(labels[1], Outlier::extreme);
  EXPECT_EQ(labels.back(), Outlier::extreme);
  EXPECT_EQ(std::ranges::count(labels, Outlier::no), 87);
}

TEST(Outliers, BeginBeyondOneAndAHalfAndThreeRangesOfTheQuartiles) {
  // Of 11 samples the quartiles are the third and the ninth: 3 and 9, which are 6 apart. The fences are 9
  // from them, at -6 and 18, and 18 from them, at -15 and 27; a sample on a fence is within it.
  const auto label = [](double sample) {
    return outliers(
        std::vector<double>{sample < 3 ? sample : 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, sample > 9 ? sample : 11});
  };
  for (const double sample : {18.0, 18.001, 20.999, 27.0}) {
    const Outlier expected = sample > 18 ? Outlier::mild : Outlier::no;
    EXPECT_EQ(label(sample).back(), expected) << sample;
    EXPECT_EQ(label(12 - sample).front(), expected) << 12 - sample;
  }
  EXPECT_EQ(label(27.001).back(), Outlier::extreme);
  EXPECT_EQ(label(-15.001).front(), Outlier::extreme);
}

TEST(Outliers, DoNotExistAmongFewOrEqualSamples) {
  for (const std::vector<double>& samples :
       {std::vector{1.0}, {1.0, 9.0}, {1.0, 2.0, 900.0}, std::vector<double>(20, 3.0)}) {
    const std::vector<Outlier> labels = outliers(samples);
    EXPECT_EQ(labels, std::vector(samples.size(), Outlier::no)) << samples.size();
  }
}

TEST(Outliers, NeedFiniteSamples) {
  EXPECT_THROW(outliers({}), std::invalid_argument);
  EXPECT_THROW(outliers(std::vector{1.0, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
