#pragma once

#include <cstdint>
#include <string>

namespace mssim {

/// The shortest decimal text that reads back as the same number, in every locale.
std::string decimal(double value);

/// Three significant digits, without an exponent.
std::string three_digits(double value);

/// Two significant digits, with an exponent where the number is small or large ("2.1e-07"): for numbers that
/// differ by orders of magnitude.
std::string two_digits(double value);

/// With `digits` behind the point, rounded, without an exponent.
std::string fixed_decimal(double value, int digits);

/// 4188004 as 4,188,004.
std::string grouped(std::uint64_t number);

}  // namespace mssim
