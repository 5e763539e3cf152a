#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace mssim {

/// First and third quartile: the samples number p (n + 1), p = 1/4 and 3/4, counted from 1 in ascending
/// order, interpolated between two and kept within the smallest and the largest.
/// Source: NIST/SEMATECH e-Handbook of Statistical Methods, section 7.1.6.
struct Quartiles {
  double first = 0;
  double third = 0;
};
/// Throws std::invalid_argument for no samples or for one that is not finite.
Quartiles quartiles(std::span<const double> samples);

/// How far a sample lies from the rest.
enum class Outlier : std::uint8_t { no, mild, extreme };

/// "", "mild" or "extreme".
std::string_view name_of(Outlier outlier);

/// A label for every sample: mild beyond the inner fences, 1.5 interquartile ranges outside the quartiles;
/// extreme beyond the outer ones, 3 of them. For the readers of samples: none is left out of any number.
/// Source: J. W. Tukey, Exploratory Data Analysis, Addison-Wesley 1977. Throws like quartiles().
std::vector<Outlier> outliers(std::span<const double> samples);

}  // namespace mssim
