#pragma once

#include <string>

namespace mssim {

/// What the Error says that `call` throws; empty where it throws nothing.
template <class Error, class Call>
std::string sentence_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace mssim
