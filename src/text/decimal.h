#pragma once

#include <string>

namespace mssim {

/// The shortest decimal text that reads back as the same number, in every locale.
std::string decimal(double value);

}  // namespace mssim
