#pragma once

#include <ostream>
#include <string>
#include <string_view>

namespace mssim {

/// What a launcher of MPI and its ranks print, of which some lines say why they have failed.
class LauncherOutput {
 public:
  /// Lines that a reader may want to see are passed on, to a stream that lives as long.
  explicit LauncherOutput(std::ostream& passed_on) : passed_on_(passed_on) {}

  /// The next bytes, which need not end with a line.
  void take(std::string_view bytes);
  /// Whether the ranks have said that they have started (launch_words.h).
  bool ranks_started() const { return started_; }
  /// Whether a rank has said why it has failed.
  bool rank_has_failed() const { return !of_rank_.empty(); }
  /// Why they have failed, in a sentence: what a rank has said first; or else the last line of the launcher
  /// that names one; or else what Open MPI says first between lines of dashes or asterisks, behind the line
  /// before those, which is ssh's; or else the last line.
  std::string reason() const;

 private:
  void take_line(const std::string& line);

  std::ostream& passed_on_;
  std::string unfinished_, of_rank_, about_rank_, in_frame_, before_frame_, last_;
  bool framed_ = false;  ///< in the first paragraph behind such a line
  bool started_ = false;
};

}  // namespace mssim
