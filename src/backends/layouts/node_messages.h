#pragma once

namespace mssim {

/// How the nodes that one process steps reach those that step their neighbours, which have them as ghosts:
/// what ColumnMessages are for cloths. Once a stage, and between two stages.
class NodeMessages {
 public:
  NodeMessages() = default;
  NodeMessages(const NodeMessages&) = delete;
  NodeMessages& operator=(const NodeMessages&) = delete;
  virtual ~NodeMessages() = default;

  /// The records of the edge nodes in the pair that the next stage gathers are complete: sends them. Does not
  /// wait.
  virtual void begin(const float* records) = 0;
  /// Lets messages that are under way go on. Does not wait.
  virtual void advance() = 0;
  /// Waits until the records of the ghosts are in the pair that the stage gathers.
  /// Throws nothing, like the others: threads of a step call them, one at a time.
  virtual void finish(float* records) = 0;
};

}  // namespace mssim
