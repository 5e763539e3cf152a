// A program that is a backend, as users write them with mssim_backend.h, without that header's conversation:
// it answers mssim itself, because its argument names something that it does wrong.
// tests/commands/own_backend_test.sh says what mssim makes of each. It steps the list of springs in double
// precision.

#include <csignal>
#include <iostream>
#include <limits>

#include "mssim_backend.h"

namespace {

using mssim_backend::Backend, mssim_backend::Method, mssim_backend::System, mssim_backend::Vector,
    mssim_backend::Vectors, mssim_backend::stepped_by;
namespace detail = mssim_backend::detail;

std::unique_ptr<Backend> prepare(const System& system, const Method& method) {
  return stepped_by(system, method, [&system](const Vectors& x, const Vectors& v, Vectors& a) {
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) a[i][k] = system.gravity[k] - system.viscous_damping * v[i][k];
    for (std::size_t s = 0; s < system.springs.size(); ++s) {
      const auto [i, j] = system.springs[s];
      Vector d{};
      double squared = 0, closing = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = x[j][k] - x[i][k];
        squared += d[k] * d[k];
        closing += d[k] * (v[j][k] - v[i][k]);
      }
      const double length = std::sqrt(squared);
      const double pull =
          (system.stiffness[s] * (length - system.rest_length[s]) + system.damping[s] * closing / length) /
          length;
      for (std::size_t k = 0; k < 3; ++k) {
        a[i][k] += pull * d[k] / system.mass[i];
        a[j][k] -= pull * d[k] / system.mass[j];
      }
    }
  });
}

/// What the program does wrong, by the word that it was started with.
class Mistakes {
 public:
  explicit Mistakes(std::string word) : word_(std::move(word)) {}

  bool is(const char* word) const { return word_ == word; }

  void before_ready(const detail::Lines& lines) const {
    if (is("unsupported")) lines.tell("unsupported it has only red springs");
    if (is("unavailable")) lines.tell("unavailable there is no such chip here");
    if (is("fails-early")) lines.tell("failed the licence has run out");
    if (is("many-notes"))
      for (int i = 0; i < 1000; ++i) lines.tell("note again");
    if (is("crashes")) std::raise(SIGSEGV);
    if (is("hangs-early")) ::pause();
    if (is("tells-costs") || is("many-costs") || is("huge-costs")) lines.tell("tells costs");
  }

  /// True where the step is not taken.
  bool at_step(std::optional<detail::Lines>& lines) {
    if (++steps_ < 3) return false;
    if (is("exits")) {
      std::cerr << "out of cake" << std::endl;
      std::exit(3);
    }
    if (is("hangs") || is("ignores-signals") || is("leaves-children")) ::pause();
    if (is("nonsense")) lines->tell("hello");
    if (is("binary")) lines->tell(std::string("\x01\xff\0", 3));
    if (is("fails")) lines->tell("failed a spring has snapped");
    if (is("closes")) {
      lines.reset();
      ::pause();
    }
    return is("nonsense") || is("binary") || is("fails");
  }

 private:
  std::string word_;
  int steps_ = 0;
};

void start_children(bool in_group) {
  if (::fork() != 0) return;
  if (!in_group) ::setsid();
  std::signal(SIGTERM, SIG_IGN);
  for (;;) ::pause();
}

void write_wrong_state(const detail::Simulation& simulation, const Mistakes& mistakes) {
  Vectors x, v;
  simulation.backend->get(x, v);
  if (mistakes.is("nan")) x[7][1] = std::numeric_limits<double>::quiet_NaN();
  std::FILE* file =
      std::fopen(simulation.introduction.state_file.c_str(), mistakes.is("cuts-state") ? "w" : "r+");
  std::fwrite(x.data(), sizeof(Vector), x.size(), file);
  std::fwrite(v.data(), sizeof(Vector), mistakes.is("nan") ? v.size() : v.size() - 1, file);
  std::fclose(file);
}

void serve(const std::string& mistake) {
  if (mistake == "ends-early") std::exit(0);
  std::optional<detail::Lines> lines(std::in_place, std::getenv("MSSIM_SOCKET"));
  Mistakes mistakes(mistake);
  if (mistakes.is("ignores-signals"))
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  if (mistakes.is("leaves-children"))
    for (const bool in_group : {true, false}) start_children(in_group);
  if (mistakes.is("floods"))
    for (int i = 0; i < 100000; ++i) std::cout << "flood number " << i << '\n';
  std::cout.flush();
  detail::Simulation simulation(*lines, prepare);
  mistakes.before_ready(*lines);
  for (const char* line : {"threads 1", "precision double", "note a list of springs", "ready 1"})
    lines->tell(line);
  for (std::string request = lines->hear(); request != "end"; request = lines->hear()) {
    const bool is_step = request.starts_with("step ");
    if (is_step && mistakes.at_step(lines)) continue;
    if (is_step) {
      int count = mistakes.is("idle") ? 0 : std::stoi(request.substr(5));
      if (mistakes.is("lazy")) count = std::min(count, 105);
      // A pause for each step; that of "slower" is several times as long as a step, even beside other
      // programs.
      const unsigned pause_us = mistakes.is("slow") ? 30'000 : mistakes.is("slower") ? 2'000 : 0;
      for (int i = 0; pause_us > 0 && i < count; ++i) ::usleep(pause_us);
      simulation.backend->step(count);
    } else if (request == "costs") {
      for (int times = mistakes.is("many-costs") ? 101 : 1; times > 0; --times)
        for (const char* cost : {"cost waiting 0.25", "cost bytes 96", "cost messages 2"}) lines->tell(cost);
      if (mistakes.is("huge-costs"))
        for (const char* cost : {"cost bytes 1e308", "cost latency 1e305", "cost bandwidth 1e308"})
          lines->tell(cost);
    } else if (request == "get" &&
               (mistakes.is("nan") || mistakes.is("too-few") || mistakes.is("cuts-state"))) {
      write_wrong_state(simulation, mistakes);
    } else {
      simulation.answer(request);
    }
    lines->tell(is_step && mistakes.is("tells-time") ? "done 0.25" : "done");
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    serve(argc > 1 ? argv[1] : "");
  } catch (const detail::MssimHasEnded&) {
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
