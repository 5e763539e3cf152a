#include "backends/accumulation/list_method.h"
#include "backends/accumulation/methods.h"
#include "backends/layouts/spring_colouring.h"

namespace mssim {
namespace {

class Colouring {
 public:
  Colouring(const System& system, SpringList<float>& list, std::size_t /*threads*/)
      : list_(list), colouring_(colour_springs(system.springs, system.nodes())) {}

  void prepare(const Team& team) { list_.clear_forces(team.begin(list_.nodes()), team.end(list_.nodes())); }

  void add(const Team& team, Pair gather) {
    for (std::size_t colour = 0; colour < colouring_.colours(); ++colour) {
      if (colour > 0) team.barrier.wait();
      for (const Spring& spring : team.slice_of(colouring_.of_colour(colour)))
        list_.add_force(spring, list_.force_of(spring, gather));
    }
  }

  void finish(const Team& /*team*/) {}

 private:
  SpringList<float>& list_;
  SpringColouring colouring_;
};

}  // namespace

std::unique_ptr<Backend> make_colouring(const System& system, const Integrator& integrator, double dt_s,
                                        const ExecutionOptions& options) {
  return make_list_method<Colouring>(system, integrator, dt_s, options);
}

}  // namespace mssim
