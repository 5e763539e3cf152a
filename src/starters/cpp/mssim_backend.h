// A backend of mssim in C++17, in one header. Needs HDF5's C library.
//
//     #include "mssim_backend.h"
//
//     int main() {
//       return mssim_backend::serve([](const mssim_backend::System& system, const mssim_backend::Method&
//       method) {
//         return mssim_backend::stepped_by(system, method, acceleration);
//       });
//     }
//
// `mssim new-backend NAME --language c++` writes a complete one with instructions for compiling it; mssim
// runs it with `mssim bench --scene cloth2500 --backend serial,openmp,./NAME`. All quantities are in SI
// units.
#pragma once

#include <hdf5.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <locale>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace mssim_backend {

/// x, y (up) and z; and one vector per node.
using Vector = std::array<double, 3>;
using Vectors = std::vector<Vector>;  ///< [nodes]

/// Thrown while a backend is made: the program does not support this scene or integrator. what() is the
/// reason.
struct Unsupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown while a backend is made: the program cannot run here. what() is the reason.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The floor: its height, and restitution and friction of a bounce.
struct Floor {
  double height = 0;  ///< m
  double restitution = 0;
  double friction = 0;
};

/// The grid of a cloth: node = row * columns + column.
struct Grid {
  std::uint32_t rows = 0, columns = 0;
  double spacing = 0;  ///< m
};

/// The constants of the law of a spring: applies ROW(name) to each. Springs of one kind share them.
#define MSSIM_BACKEND_SPRING_CONSTANTS(ROW) \
  ROW(stiffness) /* N/m */                  \
  ROW(damping)   /* N s/m, along the spring */

/// The simulated system. Names are those of the datasets of system.h5; nodes are in the scene's order.
struct System {
  std::string scene;                                  ///< its name
  double dt = 0;                                      ///< s, time step
  int threads = 1;                                    ///< maximum number to use
  Vectors position;                                   ///< [nodes] m, at the start
  Vectors velocity;                                   ///< [nodes] m/s, at the start
  std::vector<double> mass;                           ///< [nodes] kg
  std::vector<std::uint32_t> pins;                    ///< nodes that keep their start position, at rest
  std::vector<std::array<std::uint32_t, 2>> springs;  ///< the two nodes of each spring
  std::vector<double> rest_length;                    ///< [springs] m
#define MSSIM_BACKEND_MEMBER(name) std::vector<double> name;
  MSSIM_BACKEND_SPRING_CONSTANTS(MSSIM_BACKEND_MEMBER)  ///< [springs] each
#undef MSSIM_BACKEND_MEMBER
  std::vector<std::uint32_t> kind;  ///< [springs]
  Vector gravity{};                 ///< m/s^2
  double viscous_damping = 0;       ///< 1/s
  Floor floor;
  std::optional<Grid> grid;                              ///< cloths only
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< bodies only

  std::size_t nodes() const { return mass.size(); }

  /// Puts a node that has fallen below the floor back on its surface and changes its velocity: the falling
  /// speed is multiplied by the restitution and reversed; the sliding speed loses at most friction times the
  /// change of the vertical speed.
  void land(Vector& x, Vector& v) const {
    if (!(x[1] < floor.height)) return;
    const double rebound = v[1] < 0 ? -floor.restitution * v[1] : v[1];
    // 1e-30 keeps the quotient finite for a node that does not slide.
    const double slide = std::sqrt(v[0] * v[0] + v[2] * v[2] + 1e-30);
    const double grip = std::max(0.0, 1 - floor.friction * (rebound - v[1]) / slide);
    x[1] = floor.height;
    v = {grip * v[0], rebound, grip * v[2]};
  }
};

/// The vectors of an integrator, each one vector per node. x and v are the state before the step, a is the
/// acceleration, x_next and v_next are the state after the last stage.
enum class Slot : std::size_t { x, v, x_next, v_next, x_a, v_a, x_b, v_b, a, temporary_1, temporary_2 };
inline constexpr std::array slot_names{"x",   "v",   "x_next", "v_next",      "x_a",        "v_a",
                                       "x_b", "v_b", "a",      "temporary_1", "temporary_2"};

/// coefficient * dt^power * slot
struct Term {
  double coefficient = 0;
  int power = 0;
  Slot slot = Slot::x;
};

/// out = sum of the terms
struct Assignment {
  Slot out = Slot::x_next;
  std::vector<Term> terms;
};

/// Evaluates the acceleration at these two slots, then executes the assignments in order.
struct Stage {
  Slot x, v;
  std::vector<Assignment> assignments;
};

/// An integrator, as a table.
struct Method {
  std::string name;  ///< for example "rk4"
  std::vector<Stage> stages;
};

/// Description of the program for mssim.
struct About {
  std::string device = "cpu";        ///< "cpu", or "cpu " and a text; for others no roofline comparison
  std::string precision = "double";  ///< "single", or "double" and others; for these no roofline comparison
  std::string note;                  ///< for readers of its times: version, settings
  int threads = 0;                   ///< CPUs that it uses; 0: the number requested
};

/// A running simulation. An exception from any call is a failure; its what() is sent to mssim.
class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;

  /// Sets the state. Called with the start state before anything else.
  virtual void set(const Vectors& x, const Vectors& v) = 0;
  /// Takes `count` steps; they must be finished on return.
  virtual void step(int count) = 0;
  /// Copies out the state; x and v have the right size.
  virtual void get(Vectors& x, Vectors& v) = 0;

  About about;
};

/// Makes the backend for a scene and an integrator; both references stay valid while it lives. Called once.
using Prepare = std::function<std::unique_ptr<Backend>(const System&, const Method&)>;

/// out = sum of factor * slot over the terms. The first term is the large one: it is added last, so it is
/// rounded once. `out` may be one of the slots.
template <std::size_t terms>
void add_up(double* out, const double* const* slot, const double* factor, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    double sum = factor[terms - 1] * slot[terms - 1][i];
    for (std::size_t t = terms - 1; t-- > 0;) sum += factor[t] * slot[t][i];
    out[i] = sum;
  }
}

/// Takes the steps of any method, given an acceleration: see stepped_by.
template <class Acceleration>
class MethodBackend final : public Backend {
 public:
  MethodBackend(const System& system, const Method& method, Acceleration acceleration)
      : system_(system),
        method_(method),
        acceleration_(std::move(acceleration)),
        free_(system.nodes(), true) {
    for (const std::uint32_t pin : system.pins) free_[pin] = false;
    for (Vectors& slot : slots_) slot.resize(system.nodes());
  }

  void set(const Vectors& position, const Vectors& velocity) override {
    at(Slot::x) = position;
    at(Slot::v) = velocity;
  }
  void get(Vectors& position, Vectors& velocity) override {
    position = at(Slot::x);
    velocity = at(Slot::v);
  }

  void step(int count) override {
    for (; count > 0; --count) {
      for (const Stage& stage : method_.stages) {
        acceleration_(std::as_const(at(stage.x)), std::as_const(at(stage.v)), at(Slot::a));
        for (const std::uint32_t pin : system_.pins) at(Slot::a)[pin] = {};  // its slots stay at the start
        for (const Assignment& assignment : stage.assignments) assign(assignment);
      }
      Vectors &position = at(Slot::x_next), &velocity = at(Slot::v_next);
      for (std::size_t i = 0; i < system_.nodes(); ++i)
        if (free_[i]) system_.land(position[i], velocity[i]);
      at(Slot::x).swap(position);
      at(Slot::v).swap(velocity);
    }
  }

 private:
  Vectors& at(Slot slot) { return slots_[static_cast<std::size_t>(slot)]; }

  void assign(const Assignment& assignment) {
    std::array<const double*, most_terms> slot{};
    std::array<double, most_terms> factor{};
    for (std::size_t t = 0; t < assignment.terms.size(); ++t) {
      const Term& term = assignment.terms[t];
      slot[t] = at(term.slot).data()->data();
      factor[t] = term.coefficient * std::pow(system_.dt, term.power);
    }
    constexpr std::array unrolled{add_up<1>, add_up<2>, add_up<3>, add_up<4>, add_up<5>};
    unrolled.at(assignment.terms.size() - 1)(at(assignment.out).data()->data(), slot.data(), factor.data(),
                                             3 * system_.nodes());
  }

  static constexpr std::size_t most_terms = 5;
  const System& system_;
  const Method& method_;
  Acceleration acceleration_;
  std::vector<char> free_;                        ///< [nodes]
  std::array<Vectors, slot_names.size()> slots_;  ///< [nodes] each
};

/// A backend for any method from acceleration(x, v, a), which writes the acceleration of each node, m/s^2,
/// into a. It may ignore pinned nodes and the floor.
template <class Acceleration>
std::unique_ptr<Backend> stepped_by(const System& system, const Method& method, Acceleration acceleration) {
  return std::make_unique<MethodBackend<Acceleration>>(system, method, std::move(acceleration));
}

// Implementation: the protocol between the program and mssim.

namespace detail {

inline constexpr const char* protocol = "1";

/// Thrown when mssim has closed the socket.
struct MssimHasEnded {};

/// The text without line ends, cut to the maximum length of a line.
inline std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  if (text.size() > 4000) text.resize(4000);
  return text;
}

inline bool has_words(const std::string& text) {
  return text.find_first_not_of(" \t\r\n") != std::string::npos;
}

/// Line-based I/O on the socket.
class Lines {
 public:
  explicit Lines(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) throw std::runtime_error("MSSIM_SOCKET is too long");
    path.copy(address.sun_path, path.size());
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot connect to MSSIM_SOCKET");
  }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;
  ~Lines() { ::close(socket_); }

  /// The next line.
  std::string hear() {
    for (;;) {
      const std::size_t end = heard_.find('\n');
      if (end != std::string::npos) {
        std::string line = heard_.substr(0, end);
        heard_.erase(0, end + 1);
        return line;
      }
      std::array<char, 4096> bytes;
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) throw MssimHasEnded();
      heard_.append(bytes.data(), static_cast<std::size_t>(count));
    }
  }

  void tell(const std::string& line) const {
    const std::string bytes = line + '\n';
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) throw MssimHasEnded();
      sent += static_cast<std::size_t>(count);
    }
  }

 private:
  int socket_;
  std::string heard_;
};

/// Reader of system.h5.
class SystemFile {
 public:
  explicit SystemFile(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    if (file_ < 0) throw std::runtime_error("cannot open " + path);
  }
  SystemFile(const SystemFile&) = delete;
  SystemFile& operator=(const SystemFile&) = delete;
  ~SystemFile() { H5Fclose(file_); }

  bool has(const char* name) const { return H5Lexists(file_, name, H5P_DEFAULT) > 0; }

  /// All elements of a dataset; T may be an array that groups numbers.
  template <class Number, class T = Number>
  std::vector<T> read(const char* name) const {
    const hid_t data = H5Dopen2(file_, name, H5P_DEFAULT);
    if (data < 0) throw std::runtime_error(std::string("system.h5 has no ") + name);
    const hid_t space = H5Dget_space(data);
    std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * sizeof(Number) /
                          sizeof(T));
    const hid_t type = std::is_same_v<Number, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT32;
    const herr_t status = H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Dclose(data);
    if (status < 0) throw std::runtime_error(std::string("cannot read ") + name + " of system.h5");
    return values;
  }
  template <class Number>
  Number read_one(const char* name) const {
    return read<Number>(name).at(0);
  }

 private:
  hid_t file_;
};

inline void read_system(System& system, const std::string& path) {
  using Index = std::uint32_t;
  const SystemFile file(path);
  system.position = file.read<double, Vector>("position");
  system.velocity = file.read<double, Vector>("velocity");
  system.mass = file.read<double>("mass");
  system.pins = file.read<Index>("pins");
  system.springs = file.read<Index, std::array<Index, 2>>("springs");
  system.rest_length = file.read<double>("rest_length");
#define MSSIM_BACKEND_READ(name) system.name = file.read<double>(#name);
  MSSIM_BACKEND_SPRING_CONSTANTS(MSSIM_BACKEND_READ)
#undef MSSIM_BACKEND_READ
  system.kind = file.read<Index>("kind");
  system.gravity = file.read<double, Vector>("gravity").at(0);
  system.viscous_damping = file.read_one<double>("viscous_damping");
  system.floor = {file.read_one<double>("floor/height"), file.read_one<double>("floor/restitution"),
                  file.read_one<double>("floor/friction")};
  if (file.has("grid"))
    system.grid = Grid{file.read_one<Index>("grid/rows"), file.read_one<Index>("grid/columns"),
                       file.read_one<double>("grid/spacing")};
  if (file.has("tetrahedra")) system.tetrahedra = file.read<Index, std::array<Index, 4>>("tetrahedra");
}

inline Slot slot_named(const std::string& name) {
  const auto found = std::find(slot_names.begin(), slot_names.end(), name);
  if (found == slot_names.end())
    throw std::runtime_error("mssim names a slot " + name + ", which is not known here");
  return static_cast<Slot>(found - slot_names.begin());
}

/// A number in the words of mssim, which has a decimal point in every locale of the program.
inline double number_of(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0;
  if (!(stream >> number)) throw std::runtime_error("mssim sends \"" + text + "\" for a number");
  return number;
}

/// "v_next 1 0 v 1 1 a"
inline Assignment assignment_of(std::istream& words) {
  Assignment assignment;
  std::string coefficient, power, slot;
  words >> slot;
  assignment.out = slot_named(slot);
  while (words >> coefficient >> power >> slot)
    assignment.terms.push_back({number_of(coefficient), std::stoi(power), slot_named(slot)});
  return assignment;
}

/// Data that mssim sends before `prepare`: the scene, the integrator and the paths of files.
struct Introduction {
  System system;
  Method method;
  std::string state_file;

  explicit Introduction(Lines& lines) {
    for (std::string line = lines.hear(); line != "prepare"; line = lines.hear()) {
      const std::string word = line.substr(0, line.find(' '));
      const std::string rest = line.substr(std::min(line.size(), word.size() + 1));
      std::istringstream words(rest);
      if (word == "mssim-backend" && rest != protocol)
        throw std::runtime_error("mssim speaks protocol " + rest + ", mssim_backend.h " + protocol);
      if (word == "scene") system.scene = rest;
      if (word == "dt") system.dt = number_of(rest);
      if (word == "threads") system.threads = std::stoi(rest);
      if (word == "integrator") method.name = rest;
      if (word == "assign")
        method.stages.at(method.stages.size() - 1).assignments.push_back(assignment_of(words));
      if (word == "system") read_system(system, rest);
      if (word == "state") state_file = rest;
      if (word == "stage") {
        std::string position, velocity;
        words >> position >> velocity;
        method.stages.push_back({slot_named(position), slot_named(velocity), {}});
      }
    }
  }
};

/// The simulation of a conversation, after the introduction.
struct Simulation {
  Introduction introduction;
  std::unique_ptr<Backend> backend;

  Simulation(Lines& lines, const Prepare& prepare)
      : introduction(lines), backend(prepare(introduction.system, introduction.method)) {
    backend->set(introduction.system.position, introduction.system.velocity);
  }

  std::streamsize bytes() const {
    return static_cast<std::streamsize>(introduction.system.nodes() * sizeof(Vector));
  }

  void set() const {
    Vectors x(introduction.system.nodes()), v(x.size());
    std::ifstream file(introduction.state_file, std::ios::binary);
    file.read(reinterpret_cast<char*>(x.data()), bytes()).read(reinterpret_cast<char*>(v.data()), bytes());
    if (!file) throw std::runtime_error("cannot read the state file");
    backend->set(x, v);
  }

  void get() const {
    Vectors x(introduction.system.nodes()), v(x.size());
    const std::size_t nodes = x.size();
    backend->get(x, v);
    if (x.size() != nodes || v.size() != nodes)
      throw std::runtime_error("the state has another number of nodes than the scene");
    std::fstream file(introduction.state_file, std::ios::binary | std::ios::in | std::ios::out);
    file.write(reinterpret_cast<const char*>(x.data()), bytes());
    file.write(reinterpret_cast<const char*>(v.data()), bytes());
    if (!file.flush()) throw std::runtime_error("cannot write the state file");
  }

  /// Handles a request and returns the answer.
  std::string answer(const std::string& request) const {
    if (request.rfind("step ", 0) == 0) {
      backend->step(std::stoi(request.substr(5)));
    } else if (request == "set") {
      set();
    } else if (request == "get") {
      get();
    } else {
      throw std::runtime_error("mssim requested \"" + request + "\", which mssim_backend.h does not support");
    }
    return "done";
  }
};

/// The result of `call`, or the answer for its exception.
template <class Call>
std::string outcome_of(Call call) {
  const auto answer = [](const char* outcome, const std::string& reason) {
    return outcome + (has_words(reason) ? one_line(reason) : "no reason given");
  };
  try {
    return call();
  } catch (const MssimHasEnded&) {
    throw;
  } catch (const Unsupported& reason) {
    return answer("unsupported ", reason.what());
  } catch (const Unavailable& reason) {
    return answer("unavailable ", reason.what());
  } catch (const std::exception& error) {
    return answer("failed ", error.what());
  } catch (...) {
    return "failed an exception that is not a std::exception";
  }
}

inline void hold_conversation(Lines& lines, const Prepare& prepare) {
  std::unique_ptr<Simulation> simulation;
  std::string ready = std::string("ready ") + protocol;
  const std::string outcome = outcome_of([&] {
    simulation = std::make_unique<Simulation>(lines, prepare);
    const About& about = simulation->backend->about;
    if (has_words(about.device)) lines.tell("device " + one_line(about.device));
    if (has_words(about.precision)) lines.tell("precision " + one_line(about.precision));
    if (about.threads > 0) lines.tell("threads " + std::to_string(about.threads));
    if (has_words(about.note)) lines.tell("note " + one_line(about.note));
    return ready;
  });
  lines.tell(outcome);
  if (outcome != ready) return;
  for (std::string request = lines.hear(); request != "end"; request = lines.hear())
    lines.tell(outcome_of([&] { return simulation->answer(request); }));
}

}  // namespace detail

/// Answers mssim until it ends; returns the exit code for main.
inline int serve(const Prepare& prepare) {
  const char* path = std::getenv("MSSIM_SOCKET");
  if (path == nullptr) {
    std::fputs(
        "This is a backend of mssim: mssim bench --scene cloth2500 --backend serial,openmp,./PROGRAM\n",
        stderr);
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF,
               BUFSIZ);  // so that no output is lost when mssim ends the program
  try {
    detail::Lines lines(path);
    detail::hold_conversation(lines, prepare);
  } catch (const detail::MssimHasEnded&) {
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace mssim_backend
