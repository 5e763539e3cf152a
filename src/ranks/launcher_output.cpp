#include "ranks/launcher_output.h"

#include "ranks/launch_words.h"
#include "text/text.h"

namespace mssim {

void LauncherOutput::take(std::string_view bytes) {
  unfinished_ += bytes;
  for (std::size_t end = unfinished_.find('\n'); end != std::string::npos; end = unfinished_.find('\n')) {
    take_line(unfinished_.substr(0, end));
    unfinished_.erase(0, end + 1);
  }
}

std::string LauncherOutput::reason() const {
  for (const std::string* text : {&of_rank_, &about_rank_})
    if (!text->empty()) return *text;
  if (!in_frame_.empty()) return before_frame_ + (before_frame_.empty() ? "" : "; ") + in_frame_;
  return last_.empty() ? "it printed nothing" : last_;
}

void LauncherOutput::take_line(const std::string& line) {
  if (line == ranks_have_started) {
    started_ = true;
    return;
  }
  if (line.starts_with("mpirun: Forwarding signal")) return;  // for each pause that mssim makes
  passed_on_ << line << '\n';
  if (const std::size_t mark = line.find(sentence_mark); mark != std::string::npos && of_rank_.empty())
    of_rank_ = line.substr(mark + sentence_mark.size());
  // "process rank 1 with PID 7 on node a exited on signal 9 (Killed)" (mpirun), "a: task 1: Killed" (srun)
  if (line.find(" rank ") != std::string::npos || line.find(" task ") != std::string::npos)
    about_rank_ = line;
  // Open MPI's note, now and then, that its ssh has ended sooner than it could be put into a group: no
  // reason.
  if (line.find("plm:rsh: Warning: setpgid(") != std::string::npos) return;
  const bool is_blank = line.find_first_not_of(" \t\r") == std::string::npos;
  const bool is_frame = !is_blank && !has_words(line);
  if (is_frame || is_blank) {
    framed_ = is_frame && in_frame_.empty();
    if (framed_) before_frame_ = last_;
    return;
  }
  last_ = line;
  if (framed_) in_frame_ += (in_frame_.empty() ? "" : " ") + line;
}

}  // namespace mssim
