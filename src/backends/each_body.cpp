#include <algorithm>
#include <utility>
#include <vector>

#include "backends/backends.h"
#include "model/node_shape.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A body as a system of its own.
struct OneBody {
  System system;
  std::vector<std::uint32_t> scene_node;  ///< [nodes] ascending
  std::unique_ptr<Backend> backend = {};  ///< that steps it
};

std::vector<OneBody> split(const System& scene) {
  const auto* mesh = std::get_if<TetrahedralMesh>(&scene.topology);
  if (mesh == nullptr || mesh->tetrahedra.empty())
    throw Unsupported(
        "it steps the bodies of a scene one after the other, and this scene has none: name the backend "
        "without the suffix");
  const std::vector<std::uint32_t> body = bodies_of(mesh->tetrahedra, scene.nodes());
  std::vector<OneBody> bodies(1 + std::ranges::max(body));
  std::vector<std::uint32_t> place(scene.nodes());  // of a node in its body
  std::vector<TetrahedralMesh> meshes(bodies.size());
  for (OneBody& one : bodies) one.system = with_laws_of(scene);
  for (std::uint32_t node = 0; node < scene.nodes(); ++node) {
    auto& [system, scene_node, backend] = bodies[body[node]];
    place[node] = static_cast<std::uint32_t>(scene_node.size());
    scene_node.push_back(node);
    system.node_mass.push_back(scene.node_mass[node]);
    system.start.add(scene.start.position[node], scene.start.velocity[node]);
  }
  for (const std::uint32_t pin : scene.pins) bodies[body[pin]].system.pins.push_back(place[pin]);
  for (Spring spring : scene.springs) {
    System& system = bodies[body[spring.first]].system;
    spring.first = place[spring.first];
    spring.second = place[spring.second];
    system.springs.push_back(spring);
  }
  for (Tetrahedron corners : mesh->tetrahedra) {
    std::vector<Tetrahedron>& tetrahedra = meshes[body[corners.front()]].tetrahedra;
    for (std::uint32_t& corner : corners) corner = place[corner];
    tetrahedra.push_back(corners);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].system.topology = std::move(meshes[i]);
  return bodies;
}

/// Steps only mssim's own backends, so it does not pass on the questions that only users' programs answer.
class EachBody final : public Backend {
 public:
  EachBody(const System& scene, const MakeBackend& make) : nodes_(scene.nodes()), bodies_(split(scene)) {
    for (OneBody& body : bodies_) body.backend = make(body.system);
  }

  void set_state(const State& state) override {
    for (const OneBody& body : bodies_) {
      State its;
      for (const std::uint32_t node : body.scene_node) its.add(state.position[node], state.velocity[node]);
      body.backend->set_state(its);
    }
  }
  void step(int count) override {
    for (int step = 0; step < count; ++step)
      for (const OneBody& body : bodies_) body.backend->step(1);
  }
  State state() const override {
    State state;
    state.position.resize(nodes_);
    state.velocity.resize(nodes_);
    for (const OneBody& body : bodies_) {
      const State its = body.backend->state();
      for (std::size_t i = 0; i < body.scene_node.size(); ++i) {
        state.position[body.scene_node[i]] = its.position[i];
        state.velocity[body.scene_node[i]] = its.velocity[i];
      }
    }
    return state;
  }
  std::string device() const override { return first().device(); }
  int threads() const override { return std::ranges::max(of_each(&Backend::threads)); }
  int steps_per_pass() const override { return std::ranges::min(of_each(&Backend::steps_per_pass)); }
  std::optional<std::uint64_t> stored_springs() const override {
    std::uint64_t sum = 0;
    for (const OneBody& body : bodies_)
      sum += body.backend->stored_springs().value_or(body.system.springs.size());
    return sum;
  }
  bool runs_on_host() const override { return first().runs_on_host(); }
  std::string note() const override {
    std::string all;
    for (const std::string& note : of_each(&Backend::note))
      if (all.find(note) == std::string::npos) append_sentence(all, note);
    return all;
  }

 private:
  const Backend& first() const { return *bodies_.front().backend; }
  /// What each backend says.
  template <class Result>
  std::vector<Result> of_each(Result (Backend::*question)() const) const {
    std::vector<Result> answers;
    for (const OneBody& body : bodies_) answers.push_back((*body.backend.*question)());
    return answers;
  }

  std::size_t nodes_;
  std::vector<OneBody> bodies_;  ///< whose systems stay where they are
};

}  // namespace

std::unique_ptr<Backend> make_for_each_body(const System& system, const MakeBackend& make) {
  return std::make_unique<EachBody>(system, make);
}

}  // namespace mssim
