#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "backends/interface/communication.h"

namespace mssim {

/// An answer that says that the program has failed, or that is none. what() is the predicate of a sentence,
/// without the program's name: "failed at ...".
struct AnswerFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Characters of what a program says that are shown at most.
inline constexpr std::size_t longest_shown = 300;

/// What a program says of itself before it is ready.
struct Introduction {
  std::string device = "cpu";
  int threads = 0;
  std::string note;
  std::string untimed;
  bool tells_costs = false;  ///< it knows the request `costs`
};

// Each takes a line that a program answers, and throws AnswerFailure for one that is not expected.

/// One of the answers to `prepare`; true where it is the last. Throws Unsupported and Unavailable as the
/// program says them.
bool take_introduction(Introduction& introduction, const std::string& line);

/// One of the answers to `costs`; true where it is the last.
bool take_cost(Communication& costs, const std::string& line);

/// The answer to any other request: that it is done. `timed`: it may say how long that took.
void take_done(const std::string& request, const std::string& line, bool timed);

}  // namespace mssim
