#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "ranks/messages.h"
#include "ranks/piece.h"
#include "ranks/requests.h"
#include "scene/scene_file.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A request from rank 0 to all ranks, including itself.
struct Wish {
  enum Kind : int { set, restart, step, get, window, costs, end };
  int kind = end;
  int count = 0;          ///< number of steps
  double seconds = 0;     ///< time by which positions are ahead of the start
  GridWindow nodes = {};  ///< nodes of a window
};

/// mssim's introduction to rank 0, as a text for the other ranks. Only rank 0 needs the scene's file and the
/// environment that mssim has set.
std::string job_text(const std::map<std::string, std::string>& introduction, int ranks, bool copies) {
  const std::filesystem::path file = variable("MSSIM_SCENE_FILE");
  const int processors = number_in<int>(introduction.at("threads")).value_or(1);
  const std::string path = file.string();  // of any bytes, which a text in JSON may not have
  return nlohmann::json{{"file", std::vector<int>(path.begin(), path.end())},
                        {"scene", load_scene(file).source},
                        {"integrator", introduction.at("integrator")},
                        {"dt", introduction.at("dt")},
                        {"threads", std::max(1, processors / ranks)},
                        {"exact_roots", variable("MSSIM_ROOTS") == "exact"},
                        {"copies", copies}}
      .dump();
}

RankJob job_of(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text);
  RankJob job;
  const auto path = json.at("file").get<std::vector<int>>();
  job.scene = parse_scene(std::string(path.begin(), path.end()), json.at("scene").get<std::string>());
  const auto name = json.at("integrator").get<std::string>();
  job.integrator = find_integrator(name);
  if (!job.integrator) throw Unsupported("it has no " + name);
  job.dt_s = number_in<double>(json.at("dt").get<std::string>()).value();
  job.threads = json.at("threads").get<int>();
  job.roots = json.at("exact_roots").get<bool>() ? Roots::exact : Roots::fast;
  job.copies = json.at("copies").get<bool>();
  return job;
}

/// "2 threads", or "1 to 3 threads" if these ranks differ.
std::string threads_in_words(const std::vector<int>& threads) {
  const auto [fewest, most] = std::ranges::minmax(threads);
  return (fewest < most ? fmt::format("{} to ", fewest) : "") +
         pluralize(static_cast<std::uint64_t>(most), "thread");
}

/// Binds the ranks of a host to CPUs of their own, one per thread, if there are enough and the ranks are not
/// yet bound. `threads`: [ranks] of each; this one has started `started` of its own. Returns a description if
/// they have to share CPUs; empty otherwise.
std::string take_processors(const Session& session, const std::vector<int>& threads, int started = 1) {
  const std::vector<int> cpus = process_cpus();
  std::string own;
  for (const int cpu : cpus) own += fmt::format("{} ", cpu);
  const std::vector<std::string> all = session.gather(own);
  const auto self = static_cast<std::size_t>(session.rank());
  bool same = true;
  int first = 0;          // CPU of this rank
  std::vector<int> here;  // threads of the ranks on these CPUs
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    if (session.hosts()[rank] != session.hosts()[self]) continue;
    same = same && all[rank] == own;
    if (rank < self) first += threads[rank];
    here.push_back(threads[rank]);
  }
  if (!same) here = {threads[self]};
  if (std::ssize(cpus) < std::reduce(here.begin(), here.end()))
    return fmt::format("{} of {} on {} of {}", pluralize(here.size(), "rank"), threads_in_words(here),
                       pluralize(cpus.size(), "processor"), session.hosts()[self]);
  if (!same) return "";
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int i = first; i < first + threads[self]; ++i)
    CPU_SET(static_cast<std::size_t>(cpus[static_cast<std::size_t>(i)]), &set);
#pragma omp parallel num_threads(started)
  ::sched_setaffinity(0, sizeof set, &set);
  return "";
}

/// The first nonempty text.
std::string first_of(const std::vector<std::string>& texts) {
  const auto found = std::ranges::find_if(texts, [](const std::string& text) { return !text.empty(); });
  return found == texts.end() ? "" : *found;
}

/// Rank 0's answers for all ranks before "ready 1". `threads`: [ranks] of each.
void introduce(const Session& session, const Piece& piece, const std::vector<int>& threads,
               const std::string& crowded, Requests& requests) {
  std::vector<std::string> hosts = session.hosts();
  std::ranges::sort(hosts);
  const auto host_count = static_cast<std::uint64_t>(std::unique(hosts.begin(), hosts.end()) - hosts.begin());
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> version{};
  int length = 0;
  MPI_Get_library_version(version.data(), &length);
  std::string library(version.data(), static_cast<std::size_t>(length));
  library = library.substr(0, library.find(','));
  requests.answer("device " + (host_count > 1 ? pluralize(host_count, "host") + " of " : "") +
                  piece.device());
  requests.answer(fmt::format("threads {}", std::reduce(threads.begin(), threads.end())));
  if (piece.steps_per_pass() > 0) requests.answer(fmt::format("pass {}", piece.steps_per_pass()));
  requests.answer("precision single");
  requests.answer("tells costs");
  requests.answer(fmt::format("note {}, {} of {}, {}", library, pluralize(threads.size(), "rank"),
                              threads_in_words(threads), piece.note()));
  if (!crowded.empty()) requests.answer("untimed " + crowded);
  requests.answer("ready 1");
}

/// Parses a line from mssim. Throws RankFailure for an unknown request.
Wish wish_of(const std::string& line) {
  if (line == "set") return {Wish::set};
  if (line == "get") return {Wish::get};
  if (line == "costs") return {Wish::costs};
  if (line == "end") return {Wish::end};
  std::istringstream words(line);
  std::string word, rest;
  words >> word;
  if (Wish wish{.kind = Wish::restart}; word == "restart" && words >> wish.seconds && !(words >> rest))
    return wish;
  if (Wish wish{.kind = Wish::window};
      word == "get" &&
      words >> wish.nodes.row >> wish.nodes.column >> wish.nodes.rows >> wish.nodes.columns &&
      !(words >> rest))
    return wish;
  if (line.starts_with("step "))
    if (const auto count = number_in<int>(std::string_view(line).substr(5))) return {Wish::step, *count};
  throw RankFailure(fmt::format("mssim requests \"{}\", which this program does not support", line));
}

/// Handles requests from mssim until "end".
void serve(const Session& session, Piece& piece, std::optional<Requests>& requests,
           const std::filesystem::path& state_file) {
  StepCosts costs(measure_links(session));
  Wish wish;
  int steps_left = 0;  // of mssim's request, on rank 0
  for (;;) {
    if (requests && steps_left == 0) {
      wish = wish_of(requests->next());
      steps_left = wish.count;
    }
    wish.count = std::min(steps_left, costs.steps_to_meeting());
    steps_left -= wish.count;
    MPI_Request request = MPI_REQUEST_NULL;
    check_mpi(MPI_Ibcast(&wish, sizeof wish, MPI_BYTE, 0, MPI_COMM_WORLD, &request), "sharing a request");
    Session::wait_idle(request);
    if (wish.kind == Wish::end) return;
    if (wish.kind == Wish::set) scatter_state(session, state_file, piece);
    if (wish.kind == Wish::step) costs.step(session, piece, wish.count);
    if (wish.kind == Wish::get) gather_state(session, state_file, piece);
    if (wish.kind == Wish::restart) piece.restart(wish.seconds);
    if (wish.kind == Wish::window) gather_window(session, state_file, piece, wish.nodes);
    if (wish.kind == Wish::costs)
      for (const std::string& line : costs.tell(session, piece))
        if (requests) requests->answer(line);
    if (wish.kind != Wish::step) session.meet();
    if (requests && steps_left == 0) requests->answer("done");
  }
}

void work(Session& session, bool copies) {
  std::optional<Requests> requests;
  std::map<std::string, std::string> introduction;
  std::string text;
  if (session.rank() == 0) {
    std::cout << ranks_have_started << std::endl;
    requests.emplace();
    introduction = requests->read_introduction();
    text = job_text(introduction, session.ranks(), copies);
  }
  try {
    const RankJob job = job_of(session.share(text));
    std::vector<int> threads(session.hosts().size(), job.threads);
    std::string crowded = take_processors(session, threads);
    session.share_processors(!crowded.empty());
    const std::string shortage = first_of(session.gather(thread_shortage(job.threads).value_or("")));
    if (!shortage.empty()) throw Unavailable(shortage);
    const std::unique_ptr<Piece> piece = make_piece(session, job);
    std::ranges::transform(session.gather(std::to_string(piece->threads())), threads.begin(),
                           [](const std::string& number) { return std::stoi(number); });
    std::string where_crowded = first_of(session.gather(crowded));
    if (!where_crowded.empty()) {  // pieces that are too small for all their threads may leave CPUs enough
      crowded = take_processors(session, threads, piece->threads());
      session.share_processors(!crowded.empty());
      where_crowded = first_of(session.gather(crowded));
    }
    if (requests) introduce(session, *piece, threads, where_crowded, *requests);
    serve(session, *piece, requests, introduction["state"]);
  } catch (const Unsupported& unsupported) {  // thrown by all ranks
    if (requests) requests->answer(std::string("unsupported ") + unsupported.what());
  } catch (const Unavailable& unavailable) {
    if (requests) requests->answer(std::string("unavailable ") + unavailable.what());
  }
}

}  // namespace

int run_rank(int argc, char** argv) {
  omp_set_dynamic(0);  // as mssim does: OMP_DYNAMIC would take threads away
  std::optional<Session> session;
  try {
    session.emplace(&argc, &argv);
    if (session->rank() == 0) {
      const int asked = number_in<int>(variable("MSSIM_RANKS")).value_or(1);
      if (asked != session->ranks())
        throw RankFailure(fmt::format(
            "the launcher has started {} instead of {}: it may belong to an MPI other than this program's",
            pluralize(static_cast<std::uint64_t>(session->ranks()), "rank"), asked));
    }
    work(*session, argc > 2 && std::string_view(argv[2]) == copies_word);
    session.reset();
    return 0;
  } catch (const std::exception& error) {
    if (session) session->give_up(error.what());
    std::cerr << sentence_mark << error.what() << std::endl;
  }
  MPI_Abort(MPI_COMM_WORLD, 1);
  return 1;
}

}  // namespace mssim
