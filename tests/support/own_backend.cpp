// A program that is a backend, as a user may write one: it knows nothing of mssim but the protocol of
// docs/protocol.md. It steps the list of springs in double precision. Its argument names something that
// it does wrong; tests/commands/own_backend_test.sh says what mssim makes of each.

#include <hdf5.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Vectors = std::vector<std::array<double, 3>>;

struct Term {
  double coefficient = 0;
  int dt_power = 0;
  std::string slot;
};
struct Assignment {
  std::string out;
  std::vector<Term> terms;
};
struct Stage {
  std::string x, v;
  std::vector<Assignment> assignments;
};

struct Method {
  double dt = 0;
  std::string name;
  std::vector<Stage> stages;
};

struct System {
  Vectors position, velocity;
  std::vector<double> mass, rest_length, stiffness, damping, gravity;
  std::vector<std::uint32_t> pins, springs;
  double viscous_damping = 0, floor_height = 0, restitution = 0, friction = 0;
};

/// The numbers of a dataset.
template <class Number>
std::vector<Number> read(hid_t file, const char* path, hid_t type) {
  const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(dataset);
  std::vector<Number> numbers(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (dataset < 0 || H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
    throw std::runtime_error(std::string("cannot read ") + path);
  H5Sclose(space);
  H5Dclose(dataset);
  return numbers;
}

System read_system(const std::string& name) {
  const hid_t file = H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error("cannot open " + name);
  const auto doubles = [&](const char* path) { return read<double>(file, path, H5T_NATIVE_DOUBLE); };
  const auto counts = [&](const char* path) { return read<std::uint32_t>(file, path, H5T_NATIVE_UINT32); };
  const auto vectors = [&](const char* path) {
    const std::vector<double> numbers = doubles(path);
    Vectors result(numbers.size() / 3);
    for (std::size_t i = 0; i < numbers.size(); ++i) result[i / 3][i % 3] = numbers[i];
    return result;
  };
  System system{vectors("/position"),
                vectors("/velocity"),
                doubles("/mass"),
                doubles("/rest_length"),
                doubles("/stiffness"),
                doubles("/damping"),
                doubles("/gravity"),
                counts("/pins"),
                counts("/springs"),
                doubles("/viscous_damping").at(0),
                doubles("/floor/height").at(0),
                doubles("/floor/restitution").at(0),
                doubles("/floor/friction").at(0)};
  H5Fclose(file);
  return system;
}

class Simulation {
 public:
  Simulation(System system, Method method) : system_(std::move(system)), method_(std::move(method)) {
    slots_["x"] = system_.position;
    slots_["v"] = system_.velocity;
    const Vectors none(system_.position.size());
    for (const char* slot :
         {"x_next", "v_next", "x_a", "v_a", "x_b", "v_b", "a", "temporary_1", "temporary_2"})
      slots_[slot] = none;
  }

  void step() {
    for (const Stage& stage : method_.stages) {
      accelerate(slots_[stage.x], slots_[stage.v], slots_["a"]);
      for (const Assignment& assignment : stage.assignments) assign(assignment);
    }
    slots_["x"] = slots_["x_next"];
    slots_["v"] = slots_["v_next"];
    for (std::size_t i = 0; i < slots_["x"].size(); ++i) land(slots_["x"][i], slots_["v"][i]);
    for (const std::uint32_t pin : system_.pins) {
      slots_["x"][pin] = system_.position[pin];
      slots_["v"][pin] = {0, 0, 0};
    }
  }

  Vectors& position() { return slots_["x"]; }
  Vectors& velocity() { return slots_["v"]; }

 private:
  void accelerate(const Vectors& x, const Vectors& v, Vectors& a) const {
    for (auto& vector : a) vector = {0, 0, 0};
    for (std::size_t s = 0; s < system_.rest_length.size(); ++s) {
      const std::uint32_t i = system_.springs[2 * s], j = system_.springs[2 * s + 1];
      std::array<double, 3> d{};
      double squared = 0, closing = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = x[j][k] - x[i][k];
        squared += d[k] * d[k];
        closing += d[k] * (v[j][k] - v[i][k]);
      }
      const double length = std::sqrt(squared);
      const double pull =
          (system_.stiffness[s] * (length - system_.rest_length[s]) + system_.damping[s] * closing / length) /
          length;
      for (std::size_t k = 0; k < 3; ++k) {
        a[i][k] += pull * d[k] / system_.mass[i];
        a[j][k] -= pull * d[k] / system_.mass[j];
      }
    }
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) a[i][k] += system_.gravity[k] - system_.viscous_damping * v[i][k];
    for (const std::uint32_t pin : system_.pins) a[pin] = {0, 0, 0};
  }

  void assign(const Assignment& assignment) {
    Vectors sum(system_.position.size());
    for (const Term& term : assignment.terms) {
      const double factor = term.coefficient * std::pow(method_.dt, term.dt_power);
      const Vectors& slot = slots_[term.slot];
      for (std::size_t i = 0; i < sum.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) sum[i][k] += factor * slot[i][k];
    }
    slots_[assignment.out] = std::move(sum);
  }

  void land(std::array<double, 3>& x, std::array<double, 3>& v) const {
    if (x[1] >= system_.floor_height) return;
    x[1] = system_.floor_height;
    const double rebound = v[1] < 0 ? -system_.restitution * v[1] : v[1];
    const double slide = std::sqrt(v[0] * v[0] + v[2] * v[2]);
    const double grip = slide > 0 ? std::max(0.0, 1 - system_.friction * (rebound - v[1]) / slide) : 1;
    v = {grip * v[0], rebound, grip * v[2]};
  }

  System system_;
  Method method_;
  std::map<std::string, Vectors> slots_;
};

/// The socket, as lines.
class Connection {
 public:
  Connection() : socket_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, std::getenv("MSSIM_SOCKET"), sizeof address.sun_path - 1);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot connect");
  }
  bool read_line(std::string& line) const {
    line.clear();
    for (char c = 0; ::read(socket_, &c, 1) == 1;) {
      if (c == '\n') return true;
      line += c;
    }
    return false;
  }
  void send(const std::string& text) const {
    if (::write(socket_, text.data(), text.size()) < 0) std::exit(9);
  }
  void close() const { ::close(socket_); }

 private:
  int socket_;
};

/// What the program does wrong, by the word that it was started with.
class Mistakes {
 public:
  Mistakes(std::string word, Connection& connection) : word_(std::move(word)), connection_(connection) {}

  bool is(const char* word) const { return word_ == word; }

  void before_ready() const {
    if (is("unsupported")) connection_.send("unsupported it has only red springs\n");
    if (is("unavailable")) connection_.send("unavailable there is no such chip here\n");
    if (is("fails-early")) connection_.send("failed the licence has run out\n");
    if (is("many-notes"))
      for (int i = 0; i < 1000; ++i) connection_.send("note again\n");
    if (is("crashes")) std::raise(SIGSEGV);
    if (is("hangs-early")) ::pause();
    if (is("tells-costs") || is("many-costs") || is("huge-costs")) connection_.send("tells costs\n");
  }

  /// True where the step is not taken.
  bool at_step() {
    if (++steps_ < 3) return false;
    if (is("exits")) {
      std::cerr << "out of cake" << std::endl;
      std::exit(3);
    }
    if (is("hangs") || is("ignores-signals") || is("leaves-children")) ::pause();
    if (is("nonsense")) connection_.send("hello\n");
    if (is("binary")) connection_.send(std::string("\x01\xff\0\n", 4));
    if (is("fails")) connection_.send("failed a spring has snapped\n");
    if (is("closes")) {
      connection_.close();
      ::pause();
    }
    return is("nonsense") || is("binary") || is("fails");
  }

 private:
  std::string word_;
  Connection& connection_;
  int steps_ = 0;
};

void start_children(bool in_group) {
  if (::fork() != 0) return;
  if (!in_group) ::setsid();
  std::signal(SIGTERM, SIG_IGN);
  for (;;) ::pause();
}

void write_state(const std::string& name, Simulation& simulation, const Mistakes& mistakes) {
  std::FILE* file = std::fopen(name.c_str(), mistakes.is("cuts-state") ? "w" : "r+");
  const std::size_t nodes = simulation.position().size();
  if (mistakes.is("nan")) simulation.position()[7][1] = std::numeric_limits<double>::quiet_NaN();
  const std::size_t written = mistakes.is("too-few") || mistakes.is("cuts-state") ? nodes - 1 : nodes;
  std::fwrite(simulation.position().data(), sizeof(double), 3 * nodes, file);
  std::fwrite(simulation.velocity().data(), sizeof(double), 3 * written, file);
  std::fclose(file);
}

void read_state(const std::string& name, Simulation& simulation) {
  std::FILE* file = std::fopen(name.c_str(), "r");
  const std::size_t numbers = 3 * simulation.position().size();
  if (std::fread(simulation.position().data(), sizeof(double), numbers, file) +
          std::fread(simulation.velocity().data(), sizeof(double), numbers, file) !=
      2 * numbers)
    std::cerr << "the state is short\n";
  std::fclose(file);
}

void serve(const std::string& mistake) {
  if (mistake == "ends-early") std::exit(0);
  Connection connection;
  Mistakes mistakes(mistake, connection);
  if (mistakes.is("ignores-signals"))
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  if (mistakes.is("leaves-children"))
    for (const bool in_group : {true, false}) start_children(in_group);
  if (mistakes.is("floods"))
    for (int i = 0; i < 100000; ++i) std::cout << "flood number " << i << '\n';
  std::cout.flush();
  Method method;
  std::string line, word, system_file, state_file;
  while (connection.read_line(line) && line != "prepare") {
    std::istringstream words(line);
    words >> word;
    if (word == "dt") words >> method.dt;
    if (word == "integrator") words >> method.name;
    if (word == "stage") words >> method.stages.emplace_back().x >> method.stages.back().v;
    if (word == "assign") {
      Assignment& assignment = method.stages.back().assignments.emplace_back();
      words >> assignment.out;
      for (Term term; words >> term.coefficient >> term.dt_power >> term.slot;)
        assignment.terms.push_back(term);
    }
    if (word == "system") system_file = line.substr(7);
    if (word == "state") state_file = line.substr(6);
  }
  mistakes.before_ready();
  Simulation simulation(read_system(system_file), method);
  connection.send("threads 1\nprecision double\nnote a list of springs\nready 1\n");
  while (connection.read_line(line) && line != "end") {
    std::istringstream words(line);
    words >> word;
    if (word == "step") {
      int count = 0;
      words >> count;
      if (mistakes.at_step()) continue;
      if (mistakes.is("lazy")) count = std::min(count, 105);
      for (int i = 0; i < count && !mistakes.is("idle"); ++i) {
        if (mistakes.is("slow")) ::usleep(30'000);
        if (mistakes.is("slower")) ::usleep(2'000);  // several times a step, even beside other programs
        simulation.step();
      }
    }
    if (word == "costs")
      for (int times = mistakes.is("many-costs") ? 101 : 1; times > 0; --times)
        connection.send("cost waiting 0.25\ncost bytes 96\ncost messages 2\n");
    if (word == "costs" && mistakes.is("huge-costs"))
      connection.send("cost bytes 1e308\ncost latency 1e305\ncost bandwidth 1e308\n");
    if (word == "set") read_state(state_file, simulation);
    if (word == "get") write_state(state_file, simulation, mistakes);
    connection.send(word == "step" && mistakes.is("tells-time") ? "done 0.25\n" : "done\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    serve(argc > 1 ? argv[1] : "");
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
