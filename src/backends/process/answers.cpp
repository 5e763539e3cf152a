#include "backends/process/answers.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "backends/interface/backend.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr int most_threads = 4096;

/// A line's first word, and what follows it.
std::pair<std::string_view, std::string_view> split(std::string_view line) {
  const std::size_t space = line.find(' ');
  return {line.substr(0, space), space == std::string_view::npos ? "" : line.substr(space + 1)};
}

[[noreturn]] void refuse(const std::string& line, const std::string& asked, const char* expected) {
  throw AnswerFailure("answered \"" + printable(line) + "\" to \"" + asked + "\", where " + expected +
                      " is expected");
}

void refuse_failed(const std::string& line, const std::string& asked) {
  const auto [word, text] = split(line);
  if (word == "failed") throw AnswerFailure("failed at \"" + asked + "\": " + printable(text, longest_shown));
}

int thread_count(const std::string& line, std::string_view text) {
  const std::optional<int> count = number_in<int>(text);
  if (!count || *count < 1 || *count > most_threads)
    refuse(line, "prepare", "a number of threads from 1 to 4096");
  return *count;
}

bool is_at_least_zero(const std::optional<double>& number) {
  return number && *number >= 0 && std::isfinite(*number);
}

}  // namespace

bool take_introduction(Introduction& introduction, const std::string& line) {
  const auto [word, text] = split(line);
  const std::string shown = printable(text, longest_shown);
  if (word == "unsupported") throw Unsupported(shown);
  if (word == "unavailable") throw Unavailable(shown);
  refuse_failed(line, "prepare");
  if (line == "ready 1") return true;
  if (word == "device" && !text.empty())
    introduction.device = shown;
  else if (word == "threads")
    introduction.threads = thread_count(line, text);
  else if (word == "precision" && !text.empty())
    append_sentence(introduction.note, shown + " precision");
  else if (word == "note" && !text.empty())
    append_sentence(introduction.note, shown);
  else if (word == "untimed" && !text.empty())
    introduction.untimed = shown;
  else if (line == "tells costs")
    introduction.tells_costs = true;
  else
    refuse(line, "prepare",
           "device, threads, precision, note, untimed, tells costs, ready 1, unsupported, unavailable or "
           "failed");
  return false;
}

bool take_cost(Communication& costs, const std::string& line) {
  if (line == "done") return true;
  refuse_failed(line, "costs");
  const auto [word, text] = split(line);
  const auto [name, value] = split(text);
  const std::optional<double> number = number_in<double>(value);
  const bool is_cost = word == "cost" && is_at_least_zero(number);
  if (is_cost && name == "waiting" && *number <= 1)
    costs.waiting = *number;
  else if (is_cost && name == "packing" && *number <= 1)
    costs.packing = *number;
  else if (is_cost && name == "bytes")
    costs.bytes = *number;
  else if (is_cost && name == "messages")
    costs.messages = *number;
  else if (is_cost && name == "latency")
    costs.latency_s = *number;
  else if (is_cost && name == "bandwidth")
    costs.bytes_per_second = *number;
  else
    refuse(line, "costs",
           "cost waiting or cost packing and a share, cost bytes, cost messages, cost latency or cost "
           "bandwidth and a number, done or failed");
  return false;
}

void take_done(const std::string& request, const std::string& line, bool timed) {
  if (line == "done") return;
  refuse_failed(line, request);
  const auto [word, text] = split(line);
  if (!(timed && word == "done" && is_at_least_zero(number_in<double>(text))))
    refuse(line, request, "done or failed");
}

}  // namespace mssim
