#pragma once

namespace mssim {

/// How the columns of a cloth at the ends of a piece reach the processes that step the columns beside it, and
/// theirs this one: what a copy between the threads of a process is, between processes.
class ColumnMessages {
 public:
  ColumnMessages() = default;
  ColumnMessages(const ColumnMessages&) = delete;
  ColumnMessages& operator=(const ColumnMessages&) = delete;
  virtual ~ColumnMessages() = default;

  /// The columns at the ends are those of the next pass, and nothing reads the ghosts beside them any more
  /// before finish(). Does not wait.
  virtual void begin() = 0;
  /// Lets messages that are under way go on. Does not wait.
  virtual void advance() = 0;
  /// Waits until the ghosts are the neighbours' columns of the next pass, and the own ones may change again.
  /// Throws nothing, like the others: threads of a step call them.
  virtual void finish() = 0;
};

}  // namespace mssim
