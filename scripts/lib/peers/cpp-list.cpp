// Plain C++ as one would first write it: a list of springs, each of which adds its force at both ends; one
// thread.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mssim_backend.h"

namespace {

struct Vec3 {
  float x, y, z;
};
Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Node {
  Vec3 position, velocity, force;
  float mass;
  bool pinned;
};

struct Spring {
  unsigned i, j;
  float rest_length, stiffness, damping;
};

class SpringList : public mssim_backend::Backend {
 public:
  explicit SpringList(const mssim_backend::System& system)
      : dt_(static_cast<float>(system.dt)),
        gravity_(single(system.gravity)),
        viscous_(static_cast<float>(system.viscous_damping)),
        height_(static_cast<float>(system.floor.height)),
        restitution_(static_cast<float>(system.floor.restitution)),
        friction_(static_cast<float>(system.floor.friction)),
        nodes_(system.nodes()) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n].mass = static_cast<float>(system.mass[n]);
    for (const std::uint32_t pin : system.pins) nodes_[pin].pinned = true;
    for (std::size_t s = 0; s < system.springs.size(); ++s)
      springs_.push_back({system.springs[s][0], system.springs[s][1],
                          static_cast<float>(system.rest_length[s]), static_cast<float>(system.stiffness[s]),
                          static_cast<float>(system.damping[s])});
    about.threads = 1;
    about.precision = "single";
    about.note = PEER_NOTE;  // compiler, settings and the lines of this file, from whoever compiles it
  }

  void set(const mssim_backend::Vectors& x, const mssim_backend::Vectors& v) override {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_[n].position = single(x[n]);
      nodes_[n].velocity = single(v[n]);
    }
  }

  void get(mssim_backend::Vectors& x, mssim_backend::Vectors& v) override {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Node& node = nodes_[n];
      x[n] = {node.position.x, node.position.y, node.position.z};
      v[n] = {node.velocity.x, node.velocity.y, node.velocity.z};
    }
  }

  void step(int count) override {
    for (; count > 0; --count) {
      for (Node& node : nodes_) node.force = {0, 0, 0};
      for (const Spring& spring : springs_) add_force(spring);
      for (Node& node : nodes_)
        if (!node.pinned) move(node);
    }
  }

 private:
  static Vec3 single(const mssim_backend::Vector& a) {
    return {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])};
  }

  void add_force(const Spring& spring) {
    Node &a = nodes_[spring.i], &b = nodes_[spring.j];
    const Vec3 apart = b.position - a.position;
    const float length = std::sqrt(dot(apart, apart));
    const Vec3 direction = (1 / length) * apart;
    const float stretch = spring.stiffness * (length - spring.rest_length);
    const float damping = spring.damping * dot(b.velocity - a.velocity, direction);
    const Vec3 force = (stretch + damping) * direction;
    a.force = a.force + force;
    b.force = b.force - force;
  }

  void move(Node& node) const {
    Vec3 &x = node.position, &v = node.velocity;
    v = v + dt_ * ((1 / node.mass) * node.force - viscous_ * v + gravity_);
    x = x + dt_ * v;
    if (x.y >= height_) return;
    const float rebound = v.y < 0 ? -restitution_ * v.y : v.y;
    const float slide = std::sqrt(v.x * v.x + v.z * v.z + 1e-30f);
    const float grip = std::max(0.0f, 1 - friction_ * (rebound - v.y) / slide);
    x.y = height_;
    v = {grip * v.x, rebound, grip * v.z};
  }

  float dt_;
  Vec3 gravity_;
  float viscous_, height_, restitution_, friction_;
  std::vector<Node> nodes_;
  std::vector<Spring> springs_;
};

}  // namespace

int main() {
  return mssim_backend::serve([](const mssim_backend::System& system, const mssim_backend::Method& method) {
    if (method.name != "semi-euler") throw mssim_backend::Unsupported("semi-euler only");
    return std::make_unique<SpringList>(system);
  });
}
