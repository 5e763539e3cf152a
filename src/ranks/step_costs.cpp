#include "ranks/step_costs.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

void StepCosts::step(const Session& session, Piece& piece, int count) {
  const auto begin = std::chrono::steady_clock::now();
  piece.step(count);
  const auto stepped = std::chrono::steady_clock::now();
  session.meet();
  met_s_ += seconds_since(stepped);
  seconds_ += seconds_since(begin);
  steps_ += count;
}

std::vector<std::string> StepCosts::tell(const Session& session, const Piece& piece) {
  const RankCosts now = piece.costs(), before = std::exchange(told_, now);
  const double seconds = std::exchange(seconds_, 0), met_s = std::exchange(met_s_, 0),
               steps = std::exchange(steps_, 0);
  std::vector<std::string> lines;
  const auto say = [&](const char* name, double value) {
    lines.push_back(std::string("cost ") + name + ' ' + decimal(value));
  };
  double waiting = 0, packing = 0, bytes = 0, messages = 0;
  if (seconds > 0) {
    waiting = (met_s + now.waited_s - before.waited_s) / seconds;
    packing = (now.packed_s - before.packed_s) / seconds;
    bytes = static_cast<double>(now.bytes - before.bytes) / steps;
    messages = static_cast<double>(now.messages - before.messages) / steps;
  }
  double waiting_sum = 0, packing_sum = 0, most_bytes = 0, most_messages = 0;
  const std::string own =
      decimal(waiting) + ' ' + decimal(packing) + ' ' + decimal(bytes) + ' ' + decimal(messages);
  for (const std::string& text : session.gather(own)) {
    std::istringstream of_rank(text);
    of_rank >> waiting >> packing >> bytes >> messages;
    waiting_sum += waiting;
    packing_sum += packing;
    most_bytes = std::max(most_bytes, bytes);
    most_messages = std::max(most_messages, messages);
  }
  say("waiting", std::min(1.0, waiting_sum / session.ranks()));
  say("packing", std::min(1.0, packing_sum / session.ranks()));
  say("bytes", most_bytes);
  say("messages", most_messages);
  if (session.ranks() > 1) {
    say("latency", links_.latency_s);
    say("bandwidth", links_.bytes_per_second);
  }
  return lines;
}

}  // namespace mssim
